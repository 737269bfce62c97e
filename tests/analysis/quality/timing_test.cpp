#include "analysis/quality/timing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/base/random.h"

namespace haptrial::analysis {
namespace {

std::vector<record::TimingRow> bins(int count, std::int64_t width) {
  std::vector<record::TimingRow> rows;
  for (int i = 0; i < count; ++i) {
    rows.push_back({i * width, (i + 1) * width, 0, 0, 0});
  }
  return rows;
}

TEST(Percentiles, BoundThoseOfTheValuesFromAboveByABin) {
  constexpr std::int64_t kWidth = 1000;
  RandomStream random(4, "latency");
  auto rows = bins(400, kWidth);
  std::vector<double> values;
  for (int i = 0; i < 5000; ++i) {
    values.push_back(std::min(399'000.0, 1e4 * std::exp(random.normal())));
    ++rows[static_cast<std::size_t>(values.back() / kWidth)].lateness_count;
  }
  std::sort(values.begin(), values.end());
  const auto found = percentiles(rows, &record::TimingRow::lateness_count);
  ASSERT_TRUE(found);
  const auto bounds = [&](std::int64_t edge, std::size_t rank) {
    const double value = values[rank - 1];
    return static_cast<double>(edge) > value && static_cast<double>(edge) <= value + kWidth;
  };
  EXPECT_TRUE(bounds(found->median_ns, 2500));
  EXPECT_TRUE(bounds(found->p99_ns, 4950));
  EXPECT_TRUE(bounds(found->p999_ns, 4995));
  EXPECT_TRUE(bounds(found->highest_ns, 5000));
}

TEST(Percentiles, OfOneValueAreItsBin) {
  auto rows = bins(3, 10);
  rows[1].period_count = 1;
  const auto found = percentiles(rows, &record::TimingRow::period_count);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->median_ns, 20);
  EXPECT_EQ(found->highest_ns, 20);
}

TEST(Percentiles, OfNothingAreNotDefined) {
  EXPECT_FALSE(percentiles({}, &record::TimingRow::period_count));
  EXPECT_FALSE(percentiles(bins(3, 10), &record::TimingRow::period_count));
}

}  // namespace
}  // namespace haptrial::analysis
