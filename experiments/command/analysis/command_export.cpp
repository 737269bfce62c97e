#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>

#include "analysis/exchange/export_bids.h"
#include "analysis/exchange/export_csv.h"
#include "analysis/exchange/export_psych_ds.h"
#include "analysis/exchange/export_xdf.h"
#include "analysis/statistics/design/wording.h"
#include "core/base/error.h"
#include "core/record/read/session_reader.h"
#include "experiments/command/arguments.h"
#include "experiments/command/curves/curve_commands.h"
#include "experiments/command/subcommand.h"
#include "experiments/control/signals.h"
#include "experiments/runner/version.h"
#include "experiments/studies/registry.h"
#include "experiments/study/study_files.h"
#include "experiments/study/study_run.h"
#include "protocols/interface/study_rules.h"

namespace haptrial::experiments {
namespace fs = std::filesystem;
namespace {

struct ExportOptions {
  std::vector<std::string> files;
  std::string bids;
  std::string psych_ds;
  std::string xdf;
  std::string csv;
  std::string curves;
  bool samples{false};
  std::string name;
  std::vector<std::string> authors;
  std::optional<double> motion;
  std::optional<int> jobs;
};

/// Session files as they are, folders as what they hold.
std::vector<fs::path> all_files(const std::vector<std::string>& given) {
  std::vector<fs::path> files;
  for (const std::string& name : given) {
    std::error_code error;
    if (fs::is_directory(name, error)) {
      const auto found = session_files(name);
      files.insert(files.end(), found.begin(), found.end());
    } else {
      files.emplace_back(name);
    }
  }
  return files;
}

exchange::DataSetOptions data_set_options(const ExportOptions& options, int jobs) {
  return {options.name,
          options.authors,
          program_version(),
          known_phases(),
          options.motion.value_or(0.0),
          jobs,
          [](const auto& first, const auto& second) {
            return protocols::study_changes(protocol_of(first), first, second);
          }};
}

void export_as_bids(const ExportOptions& options, const std::vector<fs::path>& files, int jobs) {
  ExportWatch watch(files);
  const auto done = exchange::export_bids(files, options.bids, data_set_options(options, jobs),
                                          [&](std::uint64_t samples) { watch(samples); });
  const std::string missing =
      done.missing > 0 ? ", missing: " + analysis::counted(done.missing, "tick") : "";
  fmt::print("{} of {}, {}{}\ndata set: {}\n", analysis::counted(done.sessions, "session"),
             analysis::counted(done.subjects, "participant"),
             analysis::counted(done.samples, "sample"), missing, options.bids);
}

void export_as_psych_ds(const ExportOptions& options, const std::vector<fs::path>& files) {
  const auto done =
      exchange::export_psych_ds(files, options.psych_ds, data_set_options(options, 1));
  fmt::print("{} of {}, {}\ndata set: {}\n", analysis::counted(done.sessions, "session"),
             analysis::counted(done.subjects, "participant"),
             analysis::counted(done.passes, "pass"), options.psych_ds);
}

void export_as_xdf(const ExportOptions& options, const std::vector<fs::path>& files, int jobs) {
  ExportWatch watch(files);
  const auto done = exchange::export_xdf(files, options.xdf, jobs,
                                         [&](std::uint64_t samples) { watch(samples); });
  fmt::print("{}, {}, {}\nfiles: {}\n", analysis::counted(done.sessions, "session"),
             analysis::counted(done.streams, "stream"), analysis::counted(done.samples, "sample"),
             options.xdf);
}

void export_as_csv(const ExportOptions& options, const std::vector<fs::path>& files, int jobs) {
  ExportWatch watch(files);
  const auto done = exchange::export_csv(files, options.csv,
                                         {options.samples, known_phases(), known_tables(), jobs},
                                         [&](std::uint64_t samples) { watch(samples); });
  fmt::print("{}, {}, {}\ntables: {}\n", analysis::counted(done.sessions, "session"),
             analysis::counted(done.passes, "pass"), analysis::counted(done.samples, "sample"),
             options.csv);
}

void check_form(const ExportOptions& options) {
  const int targets = !options.bids.empty() + !options.psych_ds.empty() + !options.xdf.empty() +
                      !options.csv.empty() + !options.curves.empty();
  if (targets != 1) {
    throw InputError("give exactly one of --bids, --psych-ds, --xdf, --csv and --curves");
  }
  const std::string data_set = options.bids + options.psych_ds;
  const auto allow = [](const std::string& form, const char* name, bool given, const char* with) {
    if (form.empty() && given) {
      throw InputError(fmt::format("{} is given without {}; leave it out", name, with));
    }
  };
  allow(data_set, "--author", !options.authors.empty(), "--bids or --psych-ds");
  allow(data_set, "--name", !options.name.empty(), "--bids or --psych-ds");
  allow(options.bids, "--motion", options.motion.has_value(), "--bids");
  if (options.motion) {
    constexpr double kSlowest = 1.0, kFastest = 10'000.0;  // [Hz]
    checked_real("--motion", *options.motion, kSlowest, kFastest);
  }
  allow(options.csv, "--samples", options.samples, "--csv");
}

int export_sessions(const ExportOptions& options) {
  const int jobs = checked_jobs(options.jobs);
  check_form(options);
  watch_for_interrupt();
  const auto files = all_files(options.files);
  if (!options.bids.empty()) {
    export_as_bids(options, files, jobs);
  } else if (!options.psych_ds.empty()) {
    export_as_psych_ds(options, files);
  } else if (!options.xdf.empty()) {
    export_as_xdf(options, files, jobs);
  } else if (!options.csv.empty()) {
    export_as_csv(options, files, jobs);
  } else {
    export_curves(options.curves, files, jobs);
  }
  return 0;
}

}  // namespace

void add_export(CLI::App& app, int& status) {
  CLI::App* sub = subcommand(
      app, "export", "Write sessions in the formats of other programs",
      "haptrial export --bids data-set out/force_training-001",
      {"the folder that --bids, --psych-ds, --xdf, --csv or --curves names", "guide-analyst.md"});
  auto& o = options_of<ExportOptions>(*sub, status, export_sessions);
  sub->add_option("FILE", o.files, "Session file (.h5) or folder of session files; may be repeated")
      ->required();
  sub->add_option("--bids", o.bids, "New folder for a BIDS data set");
  sub->add_option("--motion", o.motion,
                  "Rate [Hz] of the tip's movement as Motion-BIDS, beside the recordings of --bids "
                  "(default: without)");
  sub->add_option("--psych-ds", o.psych_ds, "New folder for a Psych-DS data set");
  sub->add_option(
      "--xdf", o.xdf,
      "New folder for files of the Extensible Data Format, one for each session (.xdf)");
  sub->add_option("--csv", o.csv, "New folder for tidy tables (.csv)");
  sub->add_option("--curves", o.curves, "New folder for the scored curves (.csv)");
  sub->add_flag("--samples", o.samples,
                "Samples of every tick beside the tables of --csv (.csv.gz)");
  sub->add_option(
      "--name", o.name,
      "Name of the data set of --bids or --psych-ds (default: the name of the experiment)");
  sub->add_option("--author", o.authors, "Author of that data set; may be repeated")
      ->allow_extra_args(false);
  sub->add_option("--jobs", o.jobs, kJobsHelp);
}

}  // namespace haptrial::experiments
