#include "analysis/statistics/variance/generalized_eta.h"

#include <algorithm>
#include <limits>

#include "analysis/statistics/variance/effect_size.h"
#include "analysis/statistics/variance/repeated_anova.h"

namespace haptrial::analysis {
namespace {

using Table = std::vector<std::vector<double>>;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

double squared(double v) { return v * v; }

// SS_condition / (SS_condition + SS_participants + SS_error), the lower sum being that of all
// deviations. The rows repeat in resamples, so nothing is asked of the residuals.
double share(const Table& table, const std::vector<std::size_t>& rows) {
  const auto n = static_cast<double>(rows.size());
  const std::size_t conditions = table.front().size();
  std::vector<double> means(conditions, 0.0);
  double grand = 0.0;
  for (std::size_t c = 0; c < conditions; ++c) {
    for (const auto row : rows) {
      means[c] += table[row][c] / n;
    }
    grand += means[c] / static_cast<double>(conditions);
  }
  double between = 0.0;
  double within = 0.0;  // conditions: participants and error
  for (std::size_t c = 0; c < conditions; ++c) {
    between += n * squared(means[c] - grand);
    for (const auto row : rows) {
      within += squared(table[row][c] - means[c]);
    }
  }
  const auto result = generalized_eta_squared(between, within);
  return result ? *result : kNone;
}

}  // namespace

Defined<BootstrapInterval> generalized_eta_squared_interval(const Table& table,
                                                            const Resampling& resampling,
                                                            double level) {
  if (const auto anova = repeated_measures_anova(table); !anova) {
    return Undefined{anova.because()};
  }
  Table shifted = table;  // rounding is then relative to the differences
  for (auto& row : shifted) {
    std::transform(row.begin(), row.end(), row.begin(),
                   [&](double v) { return v - table.front().front(); });
  }
  return bootstrap(
      {table.size()}, [&](const DrawnRows& rows) { return share(shifted, rows.front()); },
      resampling, level);
}

}  // namespace haptrial::analysis
