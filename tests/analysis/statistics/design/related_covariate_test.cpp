// A made covariate correlates as stated, and adjusts a test by as much as theory says.
#include "analysis/statistics/design/related_covariate.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "analysis/statistics/base/distributions.h"
#include "analysis/statistics/base/noncentral.h"
#include "analysis/statistics/design/covariate_tests.h"
#include "analysis/statistics/design/design_sides.h"
#include "core/base/random.h"

namespace haptrial::analysis::related_covariate_test {
namespace {

constexpr double kEffect = 0.5;  // in standard deviations of what is compared

/// @param paired  the same people under both conditions, or other people
DesignTable table_of(bool paired, int people, std::uint64_t seed) {
  RandomStream random(seed, "values");
  std::vector<Observation> observations;
  for (int p = 0; p < people; ++p) {
    const std::string name = fmt::format("P{:03}", p);
    if (paired) {
      const double person = 3.0 * random.normal(), half = 0.5 * (kEffect + random.normal());
      observations.push_back({name, {"a"}, person - half});
      observations.push_back({name, {"b"}, person + half});
    } else {
      const bool a = p % 2 == 0;
      observations.push_back({name, {a ? "a" : "b"}, random.normal() + (a ? 0.0 : kEffect)});
    }
  }
  return design_table(observations, {"condition"});
}

/// The share of studies in which the adjusted test of a < b is below 5 %.
double power_of(bool paired, int people, double correlation) {
  constexpr int kStudies = 4000;
  const PlannedTest test{"a", "b", Tail::kLess};
  int found = 0;
  for (int study = 0; study < kStudies; ++study) {
    const auto seed = static_cast<std::uint64_t>(study);
    const DesignTable table = table_of(paired, people, seed);
    const Covariate covariate{"page.score", related_covariate(table, test, correlation, seed)};
    const Sides sides = values_of(table, cells_of(table, "a"), cells_of(table, "b"));
    found += adjusted_test(table, sides, covariate, test.tail)->p < 0.05 ? 1 : 0;
  }
  return static_cast<double>(found) / kStudies;
}

/// The closed form: noncentral t with one degree of freedom fewer, and 1 - r² of the variance.
double theory(bool paired, int people, double correlation) {
  const double n = people, df = n - (paired ? 2.0 : 3.0);
  const double root = paired ? std::sqrt(n) : std::sqrt(n / 4.0);
  const double shift = kEffect * root / std::sqrt(1.0 - correlation * correlation);
  return noncentral_t(t_quantile(0.95, df), df, shift).upper;
}

TEST(RelatedCovariateTest, PowerOfPairsIsThatOfTheResidualVariance) {
  for (const double correlation : {0.0, 0.6, -0.8}) {
    EXPECT_NEAR(power_of(true, 16, correlation), theory(true, 16, correlation), 0.03)
        << correlation;
  }
}

/// The chance difference of the covariate's means takes a little of it: F of n - 4 more over n - 3.
TEST(RelatedCovariateTest, PowerOfDifferentPeopleIsThatOfTheResidualVariance) {
  for (const double correlation : {0.0, 0.7}) {
    EXPECT_NEAR(power_of(false, 40, correlation), theory(false, 40, correlation), 0.035)
        << correlation;
  }
}

TEST(RelatedCovariateTest, CorrelatesAsStated) {
  const PlannedTest test{"a", "b", Tail::kTwoSided};
  const DesignTable table = table_of(true, 4000, 1);
  const auto values = related_covariate(table, test, 0.6, 1);
  double xy = 0.0, xx = 0.0, yy = 0.0;
  for (std::size_t s = 0; s < table.subjects.size(); ++s) {
    const double x = values.at(table.subjects[s]);
    const double y = *table.means[s][0] - *table.means[s][1] + kEffect;
    xy += x * y;
    xx += x * x;
    yy += y * y;
  }
  EXPECT_NEAR(xy / std::sqrt(xx * yy), 0.6, 0.04);
  EXPECT_NEAR(xx / 4000.0, 1.0, 0.08);
}

}  // namespace
}  // namespace haptrial::analysis::related_covariate_test
