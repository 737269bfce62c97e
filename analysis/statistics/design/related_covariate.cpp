#include "analysis/statistics/design/related_covariate.h"

#include <cmath>
#include <utility>
#include <vector>

#include "analysis/statistics/base/descriptive.h"
#include "analysis/statistics/design/design_sides.h"
#include "core/base/random.h"

namespace haptrial::analysis {
namespace {

/// What a test compares, less its mean, by places of participants in the table.
std::map<std::size_t, double> centred(const std::vector<std::size_t>& subjects,
                                      const std::vector<double>& values) {
  std::map<std::size_t, double> all;
  const auto found = moments(values);
  for (std::size_t i = 0; found && i < values.size(); ++i) {
    all[subjects[i]] = values[i] - found->mean();
  }
  return all;
}

std::map<std::size_t, double> compared_values(const Sides& sides) {
  if (!sides.paired) {
    std::map<std::size_t, double> all = centred(sides.subjects_a, sides.a);
    all.merge(centred(sides.subjects_b, sides.b));
    return all;
  }
  std::vector<double> differences;
  for (std::size_t i = 0; i < sides.a.size(); ++i) {
    differences.push_back(sides.a[i] - sides.b[i]);
  }
  return centred(sides.subjects_a, differences);
}

}  // namespace

std::map<std::string, double> related_covariate(const DesignTable& table, const PlannedTest& test,
                                                double correlation, std::uint64_t seed) {
  const Cells a = cells_of(table, test.a), b = cells_of(table, test.b);
  const Sides sides = a.empty() || b.empty() ? Sides{} : values_of(table, a, b);
  const auto compared = compared_values(sides);
  double squares = 0.0;
  for (const auto& [subject, value] : compared) {
    squares += value * value;
  }
  const double groups = sides.paired ? 1.0 : 2.0;
  const double deviation = std::sqrt(squares / (static_cast<double>(compared.size()) - groups));
  std::map<std::string, double> values;
  for (std::size_t s = 0; s < table.subjects.size(); ++s) {
    RandomStream random(seed, "covariate of " + table.subjects[s]);
    const auto own = compared.find(s);
    const double z = own != compared.end() && deviation > 0.0 ? own->second / deviation : 0.0;
    values[table.subjects[s]] =
        correlation * z + std::sqrt(1.0 - correlation * correlation) * random.normal();
  }
  return values;
}

}  // namespace haptrial::analysis
