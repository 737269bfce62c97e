#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "analysis/statistics/design/analysis_plan.h"
#include "analysis/statistics/design/design_json.h"
#include "analysis/statistics/design/design_lines.h"
#include "core/base/alike_names.h"
#include "core/base/error.h"
#include "core/base/file_text.h"
#include "experiments/command/arguments.h"
#include "experiments/command/subcommand.h"

namespace haptrial::experiments {
namespace {

struct StatisticsOptions {
  std::string table;
  std::vector<std::string> subject{"subject"};
  std::vector<std::string> factors{"condition"};
  std::vector<std::string> between;
  bool leave_out_missing{false};
  std::string value{"score"};
  std::vector<std::string> planned;
  std::string reference;
  int resamples{9999};
  std::string seed{"1"};
  std::string json;
  std::optional<int> jobs;
};

/// Every column has one part; only a second column of the participants may be a factor, too.
/// @throws InputError
void check_columns(const StatisticsOptions& options) {
  std::vector<std::string> columns{options.value};
  columns.insert(columns.end(), options.factors.begin(), options.factors.end());
  for (const std::string& column : options.subject) {
    if (options.subject.size() == 1 || std::ranges::count(options.factors, column) == 0) {
      columns.push_back(column);
    }
  }
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (std::find(columns.begin(), columns.begin() + static_cast<std::ptrdiff_t>(i), columns[i]) !=
        columns.begin() + static_cast<std::ptrdiff_t>(i)) {
      throw InputError(fmt::format(
          "--subject, --value and --factor name the column '{}' twice; name each column once",
          columns[i]));
    }
  }
  for (const std::string& name : options.between) {
    if (std::ranges::count(options.factors, name) == 0) {
      throw InputError(fmt::format("--between names '{}', which is no factor; allowed: '{}'", name,
                                   fmt::join(options.factors, "', '")));
    }
  }
}

/// A participant with two levels of a factor that all others have one of is a mistake in a row.
/// @throws InputError naming the participants
void check_between(const analysis::DesignTable& table, const std::vector<std::string>& between) {
  for (std::size_t f = 0; f < table.factors.size(); ++f) {
    const std::string& factor = table.factors[f].name;
    const std::vector<std::string> several = table.with_several(f);
    const bool stated = std::ranges::count(between, factor) > 0;
    if (several.empty() || (!stated && 2 * several.size() >= table.subjects.size())) {
      continue;
    }
    const auto who = std::ranges::find(table.subjects, several.front()) - table.subjects.begin();
    throw InputError(fmt::format(
        "{} {} several levels of {} ({}){}; correct the rows, or, if it is another person under "
        "each level, add --subject {}",
        fmt::join(several, ", "), several.size() == 1 ? "has" : "have", factor,
        fmt::join(table.levels_of(static_cast<std::size_t>(who), f), ", "),
        stated ? "" : ", and most participants have one", factor));
  }
}

/// Many groups of one or two people are a number that was taken for names of groups.
/// @throws InputError
void check_groups(const analysis::DesignTable& table) {
  constexpr std::size_t kManyGroups = 5;
  for (const analysis::Factor& factor : table.factors) {
    const std::size_t groups = factor.levels.size();
    if (!factor.within && groups >= kManyGroups && table.subjects.size() < 3 * groups) {
      throw InputError(fmt::format(
          "{} has {} levels for {} participants, too few in each to be compared; give a column of "
          "fewer groups, such as classes of {}",
          factor.name, groups, table.subjects.size(), factor.name));
    }
  }
}

/// A typo in a name makes a level or a participant of its own.
void warn_of_alike_names(const std::string& what, const std::vector<std::string>& names) {
  for (const std::string& warning : alike_names_warnings(what, names)) {
    fmt::print(stderr, "{}\n", warning);
  }
}

int statistics(const StatisticsOptions& options) {
  analysis::Resampling resampling;
  resampling.seed = checked_seed(options.seed);
  resampling.count =
      static_cast<std::size_t>(checked_number("--resamples", options.resamples, 0, 10'000'000));
  resampling.threads = checked_jobs(options.jobs);
  const analysis::AnalysisPlan plan =
      analysis::parse_analysis_plan(options.planned, options.reference, "--planned");
  check_columns(options);
  if (!options.json.empty() && std::filesystem::exists(options.json)) {
    throw InputError(fmt::format("{}: exists already; choose another --json", options.json));
  }
  const analysis::ObservedTable observed = analysis::read_observations(
      options.table, options.subject, options.factors, options.value, options.leave_out_missing);
  if (observed.observations.empty()) {
    throw InputError(fmt::format("{}: every row has a missing field", options.table));
  }
  const analysis::DesignTable table = analysis::design_table(
      observed.observations, options.factors,
      plan.reference.empty() ? std::vector<std::string>{} : std::vector{plan.reference});
  warn_of_alike_names("participants", table.subjects);
  check_between(table, options.between);
  check_groups(table);
  analysis::check_plan(table, plan);
  for (const analysis::Factor& factor : table.factors) {
    warn_of_alike_names("levels of " + factor.name, factor.levels);
  }
  const analysis::DesignTests tests = analysis::design_tests(table, plan, resampling);
  if (observed.left_out > 0) {
    fmt::print("Left out: {} of {} rows, which have a missing field\n", observed.left_out,
               observed.rows);
  }
  for (const std::string& line : analysis::design_lines(table, tests)) {
    fmt::print("{}\n", line);
  }
  if (!options.json.empty()) {
    write_text(options.json, analysis::design_json(tests) + "\n");
  }
  return 0;
}

}  // namespace

void add_statistics(CLI::App& app, int& status) {
  CLI::App* sub = subcommand(app, "statistics",
                             "Test a table with one value in each row, as its design calls for",
                             "haptrial statistics scores.csv --planned 'visual < haptic'",
                             {"", "algorithms/statistics.md"});
  auto& o = options_of<StatisticsOptions>(*sub, status, statistics);
  sub->add_option("TABLE", o.table, "Table (.csv), or - for standard input")->required();
  sub->add_option("--value", o.value, with_default("Column of the values", o.value));
  sub->add_option("--subject", o.subject,
                  with_default("Column of the participants", o.subject.front()) +
                      "; may be repeated, with the column of the group if each group numbers its "
                      "people anew")
      ->allow_extra_args(false);
  sub->add_option("--factor", o.factors,
                  with_default("Column of a factor; may be repeated", o.factors.front()))
      ->allow_extra_args(false);
  sub->add_flag("--leave-out-missing", o.leave_out_missing,
                "Leave out and count rows with a field that is empty, NA, NaN, N/A or '.'");
  sub->add_option("--between", o.between,
                  "Factor of which each participant has one level; may be repeated")
      ->allow_extra_args(false);
  sub->add_option("--planned", o.planned,
                  "Planned test, 'A < B', 'A > B' or 'A != B'; may be repeated")
      ->allow_extra_args(false);
  sub->add_option("--reference", o.reference, "Level that tables and comparisons begin with");
  sub->add_option(
      "--resamples", o.resamples,
      with_default("Number of random arrangements and resamples; 0 for none", o.resamples));
  sub->add_option("--seed", o.seed, with_default("Seed of the random arrangements", o.seed));
  sub->add_option("--json", o.json, "File for the unrounded numbers (.json)");
  sub->add_option("--jobs", o.jobs, kJobsHelp);
}

}  // namespace haptrial::experiments
