#include "analysis/trials/psychometric/quantity.h"

#include <gtest/gtest.h>

namespace haptrial::analysis::trials {
namespace {

/// Areas of three participants near 1: Student's interval of their mean would go beyond it.
TEST(QuantityTest, IntervalsEndWhereValuesDo) {
  const std::vector<QuantityValue> values{{"A", {}, 0.9}, {"B", {}, 1.0}, {"C", {}, 0.99}};
  Quantity areas = quantity("roc_area", "area", "", values, TrialsPlan{});
  ASSERT_EQ(areas.means.size(), 1u);
  const MeanInterval before = *areas.means[0];
  EXPECT_GT(before.high, 1.0);
  keep_within(areas, 0.0, 1.0);
  EXPECT_EQ(areas.means[0]->high, 1.0);
  EXPECT_EQ(areas.means[0]->low, before.low);
  EXPECT_EQ(areas.means[0]->mean, before.mean);
  keep_within(areas, 0.9, 1.0);
  EXPECT_EQ(areas.means[0]->low, 0.9);
}

}  // namespace
}  // namespace haptrial::analysis::trials
