#include <fmt/format.h>

#include <algorithm>

#include "analysis/statistics/design/analysis_plan.h"
#include "analysis/statistics/words/design_json.h"
#include "analysis/statistics/words/design_lines.h"
#include "core/base/error.h"
#include "core/base/files/file_text.h"
#include "core/base/text/alike_names.h"
#include "experiments/command/analysis_commands.h"
#include "experiments/command/arguments.h"

namespace haptrial::experiments {
namespace {

/// Every column has one part. @throws InputError
void check_columns(const StatisticsOptions& options, const std::vector<std::string>& factors) {
  std::vector<std::string> columns{options.subject, options.value};
  columns.insert(columns.end(), factors.begin(), factors.end());
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (std::find(columns.begin(), columns.begin() + static_cast<std::ptrdiff_t>(i), columns[i]) !=
        columns.begin() + static_cast<std::ptrdiff_t>(i)) {
      throw InputError(fmt::format(
          "--subject, --value and --factor name the column '{}' twice; name each column once",
          columns[i]));
    }
  }
}

/// A typo in a name makes a level of its own.
void warn_of_alike_levels(const analysis::DesignTable& table) {
  for (const analysis::Factor& factor : table.factors) {
    for (std::vector<std::string>& group : alike_names(factor.levels)) {
      for (std::string& name : group) {
        name = fmt::format("\"{}\"", name);
      }
      fmt::print(stderr, "{}\n", alike_names_warning("levels of " + factor.name, group));
    }
  }
}

}  // namespace

int statistics(const StatisticsOptions& options) {
  analysis::Resampling resampling;
  resampling.seed = checked_seed(options.seed);
  resampling.count =
      static_cast<std::size_t>(checked_number("--resamples", options.resamples, 0, 10'000'000));
  resampling.threads = checked_jobs(options.jobs);
  const analysis::AnalysisPlan plan =
      analysis::parse_analysis_plan(options.planned, options.reference, "--planned");
  const std::vector<std::string> factors =
      options.factors.empty() ? std::vector<std::string>{"condition"} : options.factors;
  check_columns(options, factors);
  if (!options.json.empty() && std::filesystem::exists(options.json)) {
    throw InputError(fmt::format("{}: exists already; choose another --json", options.json));
  }
  const analysis::DesignTable table = analysis::design_table(
      analysis::read_observations(options.table, options.subject, factors, options.value), factors,
      plan.reference.empty() ? std::vector<std::string>{} : std::vector{plan.reference});
  analysis::check_plan(table, plan);
  warn_of_alike_levels(table);
  const analysis::DesignTests tests = analysis::design_tests(table, plan, resampling);
  for (const std::string& line : analysis::design_lines(table, tests)) {
    fmt::print("{}\n", line);
  }
  if (!options.json.empty()) {
    write_text(options.json, analysis::design_json(tests) + "\n");
  }
  return 0;
}

}  // namespace haptrial::experiments
