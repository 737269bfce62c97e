// Change by a condition: against the paired test of means by hand, and in studies without any
// effect.

#include "analysis/bone_drilling/report/with_without.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/base/random.h"

namespace haptrial::analysis::drilling {
namespace {

TEST(WithWithoutTest, IsThePairedTestOfParticipantsMeans) {
  // Means with: 4, 7, 3; without: 2, 4, 2. Differences 2, 3, 1: mean 2, s 1, t = 2 sqrt(3).
  const std::vector<GivenValue> values{
      {"a", true, 3.0},  {"a", true, 5.0}, {"a", false, 2.0}, {"b", true, 7.0}, {"b", false, 4.0},
      {"b", false, 4.0}, {"c", true, 3.0}, {"c", false, 2.0}, {"c", false, {}}, {"d", true, 90.0}};
  const WithWithout c = with_less_without(values);
  EXPECT_EQ(c.participants, 3u) << "d was never without";
  ASSERT_TRUE(c.test);
  EXPECT_DOUBLE_EQ(c.test->difference, 2.0);
  EXPECT_NEAR(c.test->t, 2.0 * std::sqrt(3.0), 1e-12);
  EXPECT_DOUBLE_EQ(c.test->df, 2.0);
  EXPECT_THAT(difference_word(c, "N"), testing::HasSubstr("+2.00 N"));
  EXPECT_THAT(difference_word(c, ""), testing::StartsWith("+2.00, 95 %"));
  EXPECT_TRUE(has_both(values));
  EXPECT_FALSE(has_both({{"a", true, 1.0}}));
  EXPECT_THAT(difference_word(with_less_without({{"a", true, 1.0}}), "N"),
              testing::HasSubstr("not defined"));
}

/// The share of 2,000 studies without an effect in which p < 0.05. Twelve people, four procedures
/// each; people differ three times as much as their procedures, and some vary more than others.
double rejected_without_effect(double (*of)(double)) {
  RandomStream random(11, "null studies of hints");
  constexpr int kStudies = 2000;
  int rejected = 0;
  for (int study = 0; study < kStudies; ++study) {
    std::vector<GivenValue> values;
    for (int person = 0; person < 12; ++person) {
      const double own = 3.0 * random.normal();
      const double spread = random.uniform(0.5, 1.5);
      for (int trial = 0; trial < 4; ++trial) {
        values.push_back({fmt::format("P{:02}", person), (trial + person) % 2 == 0,
                          of(own + spread * random.normal())});
      }
    }
    const WithWithout c = with_less_without(values);
    rejected += c.test && c.test->p < 0.05 ? 1 : 0;
  }
  return static_cast<double>(rejected) / kStudies;
}

/// At a level of 5 %, chance leaves 3.8 to 6.3 % (99 %).
TEST(WithWithoutTest, StudiesWithoutAnEffectRejectAtTheirLevel) {
  const double normal = rejected_without_effect([](double value) { return value; });
  const double skewed = rejected_without_effect([](double value) { return std::exp(0.3 * value); });
  RecordProperty("normal", std::to_string(normal));
  RecordProperty("skewed", std::to_string(skewed));
  EXPECT_GT(normal, 0.038);
  EXPECT_LT(normal, 0.063);
  EXPECT_LT(skewed, 0.063) << "counts and rates are skewed: the test is then rather too careful";
}

}  // namespace
}  // namespace haptrial::analysis::drilling
