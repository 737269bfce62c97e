#include "core/realtime/histogram.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <thread>
#include <vector>

#include "core/base/random.h"
#include "tests/support/allocation_guard.h"

namespace haptrial::realtime {
namespace {

// Durations over twelve decades, every decade as likely as another.
std::vector<std::int64_t> durations(std::size_t n, std::uint64_t seed) {
  RandomStream random(seed, "durations");
  std::vector<std::int64_t> all(n);
  for (auto& d : all) {
    d = static_cast<std::int64_t>(std::pow(10.0, random.uniform(0.0, 12.0)));
  }
  return all;
}

TEST(DurationHistogramTest, BinsTileTheLineAndAreNarrow) {
  const DurationHistogram h;
  std::int64_t next = 0;
  for (std::size_t i = 0; i < DurationHistogram::kBins; ++i) {
    const auto bin = h.bin(i);
    ASSERT_EQ(bin.low, next) << i;
    ASSERT_GT(bin.high, bin.low) << i;
    ASSERT_LE(static_cast<double>(bin.high - bin.low),
              std::max(1.0, static_cast<double>(bin.low) / 64))
        << i;
    next = bin.high;
  }
  EXPECT_EQ(next, std::numeric_limits<std::int64_t>::max());
  EXPECT_THROW(h.bin(DurationHistogram::kBins), std::out_of_range);
}

TEST(DurationHistogramTest, EveryDurationIsCountedInTheBinThatHoldsIt) {
  auto all = durations(2000, 1);
  for (int k = 0; k < 62; ++k) {  // both sides of every octave
    all.insert(all.end(), {(std::int64_t{1} << k) - 1, std::int64_t{1} << k});
  }
  for (const auto d : all) {
    DurationHistogram h;
    h.add(d);
    for (std::size_t i = 0; i < DurationHistogram::kBins; ++i) {
      const auto bin = h.bin(i);
      ASSERT_EQ(bin.count, d >= bin.low && d < bin.high ? 1u : 0u) << d << " in bin " << i;
    }
  }
}

TEST(DurationHistogramTest, PercentilesAreThoseOfTheSortedValuesToABin) {
  auto all = durations(10001, 2);
  DurationHistogram h;
  for (const auto d : all) {
    h.add(d);
  }
  std::sort(all.begin(), all.end());
  for (const double percent : {0.0, 1.0, 25.0, 50.0, 90.0, 99.0, 99.9, 99.99, 100.0}) {
    const double rank = std::max(1.0, std::ceil(percent / 100 * static_cast<double>(all.size())));
    const auto exact = static_cast<double>(all[static_cast<std::size_t>(rank) - 1]);
    EXPECT_GE(h.percentile(percent), exact) << percent;
    EXPECT_LE(h.percentile(percent), exact * (1 + 1.0 / 64)) << percent;
  }
  EXPECT_EQ(h.percentile(100), h.max());
}

TEST(DurationHistogramTest, CountMinMaxAndMeanAreExact) {
  const auto all = durations(1000, 3);
  DurationHistogram h;
  double sum = 0;
  for (const auto d : all) {
    h.add(d);
    sum += static_cast<double>(d);
  }
  EXPECT_EQ(h.count(), all.size());
  EXPECT_EQ(h.min(), static_cast<double>(*std::min_element(all.begin(), all.end())));
  EXPECT_EQ(h.max(), static_cast<double>(*std::max_element(all.begin(), all.end())));
  EXPECT_DOUBLE_EQ(h.mean(), sum / static_cast<double>(all.size()));
}

TEST(DurationHistogramTest, NothingCountedHasNoFigures) {
  const DurationHistogram h;
  EXPECT_TRUE(std::isnan(h.min()));
  EXPECT_TRUE(std::isnan(h.max()));
  EXPECT_TRUE(std::isnan(h.mean()));
  EXPECT_TRUE(std::isnan(h.percentile(50)));
}

TEST(DurationHistogramTest, ExtremesFit) {
  DurationHistogram h;
  h.add(-5);
  h.add(std::numeric_limits<std::int64_t>::max());
  EXPECT_EQ(h.bin(0).count, 1u);
  EXPECT_EQ(h.bin(DurationHistogram::kBins - 1).count, 1u);
  EXPECT_EQ(h.min(), 0.0);
}

TEST(DurationHistogramTest, PercentBeyondItsBoundsIsRejected) {
  DurationHistogram h;
  h.add(1);
  EXPECT_THROW(h.percentile(-0.1), std::invalid_argument);
  EXPECT_THROW(h.percentile(100.1), std::invalid_argument);
  EXPECT_THROW(h.percentile(std::nan("")), std::invalid_argument);
}

TEST(DurationHistogramTest, ABinIsReadBesideAThreadThatAdds) {
  DurationHistogram histogram;
  constexpr std::uint64_t kAdded = 200'000;
  std::thread adds([&] {
    for (std::uint64_t n = 0; n < kAdded; ++n) {
      histogram.add(7);
    }
  });
  std::uint64_t last = 0;
  for (int look = 0; look < 1000; ++look) {  // a race checker looks, too
    const std::uint64_t now = histogram.bin(7).count;
    EXPECT_GE(now, last);
    last = now;
  }
  adds.join();
  EXPECT_EQ(histogram.bin(7).count, kAdded);
}

TEST(DurationHistogramTest, AddDoesNotAllocate) {
  DurationHistogram h;
  const auto all = durations(1000, 6);
  const test::AllocationGuard guard;
  for (const auto d : all) {
    h.add(d);
  }
  EXPECT_EQ(guard.count(), 0u);
}

}  // namespace
}  // namespace haptrial::realtime
