#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <optional>

#include "analysis/files/csv.h"
#include "core/base/counted.h"
#include "core/base/error.h"
#include "experiments/command/subcommand.h"
#include "experiments/studies/psychophysics/import_trials.h"

namespace haptrial::experiments {
namespace fs = std::filesystem;
namespace {

namespace trials = analysis::trials;

struct ImportOptions {
  std::vector<std::string> files;
  std::string out;
  std::string definition;
  std::vector<std::string> columns;
  std::vector<std::string> factors;
  std::vector<std::string> filters;
  std::string time_unit;
  std::string name;
  std::string kind;
  std::string yes;
  std::optional<double> guess;
};

trials::TrialColumns columns_of(const ImportOptions& options) {
  trials::TrialColumns columns =
      trials::guess_columns(analysis::CsvTable::load(options.files.front()));
  for (const std::string& setting : options.columns) {
    trials::set_column(setting, columns);
  }
  for (const std::string& setting : options.factors) {
    trials::add_factor(setting, columns);
  }
  for (const std::string& setting : options.filters) {
    trials::add_filter(setting, columns);
  }
  if (!options.time_unit.empty()) {
    columns.time_unit = options.time_unit == "s" ? 1.0 : 1e-3;
  }
  return columns;
}

/// Keys that a given definition has already.
void check_options(const ImportOptions& options) {
  const auto refuse = [&](const char* name, bool given) {
    if (!options.definition.empty() && given) {
      throw InputError(
          fmt::format("{} is given with --definition, whose [analysis] says it; leave "
                      "it out",
                      name));
    }
  };
  refuse("--name", !options.name.empty());
  refuse("--kind", !options.kind.empty());
  refuse("--yes", !options.yes.empty());
  refuse("--guess", options.guess.has_value());
}

void print_columns(const trials::TrialColumns& columns) {
  std::vector<std::string> used;
  for (const auto& [role, member] : trials::TrialColumns::roles()) {
    if (const std::string& column = columns.*member; !column.empty()) {
      used.push_back(fmt::format("{} = {}", role, column));
    }
  }
  for (const trials::FactorColumn& factor : columns.factors) {
    used.push_back(fmt::format("factor {} = {}", factor.variable, factor.column));
  }
  fmt::print("read as {}: {}\n", name_of(columns.origin), fmt::join(used, ", "));
}

int import(const ImportOptions& options) {
  check_options(options);
  TrialsImport request;
  request.files.assign(options.files.begin(), options.files.end());
  request.columns = columns_of(options);
  request.definition = options.definition;
  request.analysis = {options.name.empty() ? "imported" : options.name, options.kind, options.yes,
                      options.guess};
  request.out = options.out;
  print_columns(request.columns);
  const ImportSummary done = import_trials(request);
  fmt::print("{} of {} in {}; {} left out as no trials; {} without an answer\n",
             haptrial::counted(done.trials, "trial", "trials"),
             haptrial::counted(done.participants, "participant", "participants"),
             haptrial::counted(done.sessions, "session", "sessions"),
             haptrial::counted(done.left_out, "row", "rows"),
             haptrial::counted(done.unanswered, "trial", "trials"));
  for (const std::string& warning : done.warnings) {
    fmt::print(stderr, "{}\n", warning);
  }
  fmt::print("study: {}\n", options.out);
  return 0;
}

}  // namespace

void add_import(CLI::App& app, int& status) {
  CLI::App* sub =
      subcommand(app, "import", "Make a study of trials that another program presented",
                 "haptrial import trials.csv --factor speed --guess 0.5 --out out/imported",
                 {"session files and study.toml in the folder of --out", "guide-analyst.md"});
  auto& o = options_of<ImportOptions>(*sub, status, import);
  sub->add_option("TABLE", o.files,
                  "Table of PsychoPy, of jsPsych, or any with one trial in each row (.csv, .tsv); "
                  "may be repeated")
      ->required();
  sub->add_option("--out", o.out, "New folder for the study")->required();
  sub->add_option("--definition", o.definition,
                  "Definition of protocol \"trials\" by which the trials are analysed (default: "
                  "one is made)");
  sub->add_option(
         "--column", o.columns,
         "ROLE=COLUMN: the column for participant, session, block, track, level, answer, "
         "correct, time, rating, probe, outcome or simulated, in place of the guessed one; may "
         "be repeated")
      ->allow_extra_args(false);
  sub->add_option("--factor", o.factors, "Column of a factor, or NAME=COLUMN; may be repeated")
      ->allow_extra_args(false);
  sub->add_option("--only", o.filters,
                  "COLUMN=VALUE: rows with another value are no trials; COLUMN: rows without any; "
                  "may be repeated")
      ->allow_extra_args(false);
  sub->add_option("--time-unit", o.time_unit,
                  "Unit of reaction times: s or ms (default: s of PsychoPy, ms of jsPsych, of "
                  "other tables as "
                  "the column's name ends)")
      ->check(CLI::IsMember({"s", "ms"}));
  sub->add_option("--name", o.name, "Name of the study (default: imported)");
  sub->add_option(
      "--kind", o.kind,
      "Kind of the analysis: psychometric, detection, identification, magnitude, times or none "
      "(default: psychometric with levels and right answers, times without)");
  sub->add_option("--yes", o.yes, "Answer that counts 1 (default: the right one)");
  sub->add_option("--guess", o.guess,
                  "Guess rate of psychometric functions (default: 1 / number of answers)");
}

}  // namespace haptrial::experiments
