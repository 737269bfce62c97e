#include <fmt/format.h>

#include <filesystem>

#include "analysis/exchange/export_bids.h"
#include "analysis/exchange/export_csv.h"
#include "analysis/exchange/export_curves.h"
#include "analysis/wording.h"
#include "core/base/error.h"
#include "core/record/session_reader.h"
#include "experiments/command/arguments.h"
#include "experiments/command/commands.h"
#include "experiments/control/interrupt.h"
#include "experiments/control/progress.h"
#include "experiments/runner/version.h"
#include "experiments/study/study_files.h"
#include "experiments/study/study_run.h"
#include "experiments/studies/registry.h"

namespace haptrial::experiments {
namespace fs = std::filesystem;
namespace {

using analysis::counted;

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

/// Shows how far the export is; an interrupt ends it.
class ProgressWatch {
 public:
  explicit ProgressWatch(const std::vector<fs::path>& files)
      : sessions_(exchange::sessions_to_export(files)),
        progress_("export", static_cast<double>(exchange::total_samples(sessions_))) {}

  void operator()(std::uint64_t samples) {
    if (interrupted()) {
      throw RunError("interrupted; nothing was exported");
    }
    progress_.update(static_cast<double>(samples),
                     fmt::format("{:.1f} million samples", 1e-6 * static_cast<double>(samples)),
                     sessions_.front().info.rate);
  }

 private:
  std::vector<exchange::ExportSession> sessions_;
  Progress progress_;
};

void export_as_bids(const ExportOptions& options, const std::vector<fs::path>& files, int jobs) {
  ProgressWatch watch(files);
  const auto done = exchange::export_bids(files, options.bids,
                                          {options.name, options.authors, program_version(), jobs},
                                          [&](std::uint64_t samples) { watch(samples); });
  const std::string missing = done.missing > 0 ? ", missing: " + counted(done.missing, "tick") : "";
  fmt::print("{} of {}, {}{}\ndata set: {}\n", counted(done.sessions, "session"),
             counted(done.subjects, "participant"), counted(done.samples, "sample"), missing,
             options.bids);
}

void export_as_csv(const ExportOptions& options, const std::vector<fs::path>& files, int jobs) {
  ProgressWatch watch(files);
  const auto done = exchange::export_csv(files, options.csv, {options.samples, jobs},
                                         [&](std::uint64_t samples) { watch(samples); });
  fmt::print("{}, {}, {}\ntables: {}\n", counted(done.sessions, "session"),
             counted(done.passes, "pass"), counted(done.samples, "sample"), options.csv);
}

/// Curves do not say that they are of a pilot, so pilots must not stand among those of the study.
std::vector<fs::path> without_pilots(const std::vector<fs::path>& files) {
  std::vector<fs::path> study;
  std::vector<std::string> pilots;
  for (const fs::path& file : files) {
    if (record::SessionReader(file).info().pilot) {
      pilots.push_back(file.filename().string());
    } else {
      study.push_back(file);
    }
  }
  if (pilots.empty()) {
    return files;
  }
  if (study.empty()) {
    fmt::print("These are pilot sessions, not the study.\n");
    return files;
  }
  fmt::print("Not exported, because the session was a pilot: {}.\n", fmt::join(pilots, ", "));
  return study;
}

/// How the curves of sessions are scored. @throws InputError for one whose passes have none
CurveAnalysis analysis_of_curves(const std::vector<fs::path>& files) {
  std::optional<CurveAnalysis> first;
  for (const fs::path& file : files) {
    const record::SessionReader reader(file);
    const auto curves = study_of(reader.info()).curves(reader.info());
    if (!curves) {
      throw InputError(fmt::format(
          "{}: is a session of {}, which has no target force; --curves exports sessions whose "
          "passes have one",
          file.string(), study_of(reader.info()).protocol().name()));
    }
    first = first ? first : curves;
  }
  return *first;
}

void export_as_curves(const ExportOptions& options, const std::vector<fs::path>& given, int jobs) {
  const CurveAnalysis analysis = analysis_of_curves(given);
  const std::vector<fs::path> files = without_pilots(given);
  ProgressWatch watch(files);
  refuse_mixed(files);  // one definition says how all of them are scored
  const auto done = exchange::export_curves(files, options.curves, analysis.scoring, jobs,
                                            [&](std::uint64_t samples) { watch(samples); });
  fmt::print("{} of {}\ncurves: {}\n", counted(done.trials, "scored trial"),
             counted(done.subjects, "participant"), options.curves);
}

void check_form(const ExportOptions& options) {
  const int targets = !options.bids.empty() + !options.csv.empty() + !options.curves.empty();
  if (targets != 1) {
    throw InputError("give exactly one of --bids, --csv and --curves");
  }
  const auto allow = [](const std::string& form, const char* name, bool given, const char* with) {
    if (form.empty() && given) {
      throw InputError(fmt::format("{} is given without {}; leave it out", name, with));
    }
  };
  allow(options.bids, "--author", !options.authors.empty(), "--bids");
  allow(options.bids, "--name", !options.name.empty(), "--bids");
  allow(options.csv, "--samples", options.samples, "--csv");
}

}  // namespace

int export_sessions(const ExportOptions& options) {
  const int jobs = checked_jobs(options.jobs);
  check_form(options);
  watch_for_interrupt();
  const auto files = all_files(options.files);
  if (!options.bids.empty()) {
    export_as_bids(options, files, jobs);
  } else if (!options.csv.empty()) {
    export_as_csv(options, files, jobs);
  } else {
    export_as_curves(options, files, jobs);
  }
  return 0;
}

}  // namespace haptrial::experiments
