#include "core/geometry/parallel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <vector>

namespace haptrial::geometry {
namespace {

TEST(ParallelForTest, DoesEachItemOnce) {
  for (const int threads : {-1, 1, 2, 7}) {
    std::vector<std::atomic<int>> done(1000);
    parallel_for(done.size(), threads, [&](std::size_t i) { ++done[i]; });
    for (const auto& times : done) EXPECT_EQ(times, 1);
  }
  parallel_for(0, 4, [](std::size_t) { FAIL() << "there is nothing to do"; });
}

TEST(ParallelForTest, ThrowsWhatAnItemThrows) {
  std::atomic<int> done{0};
  const auto run = [&] {
    parallel_for(100000, 3, [&](std::size_t i) {
      if (i == 5) throw std::runtime_error("five");
      ++done;
    });
  };
  EXPECT_THROW(run(), std::runtime_error);
  EXPECT_LT(done, 100000);
}

TEST(ParallelForTest, KnowsTheProcessors) {
  EXPECT_EQ(threads_or_all(3), 3);
  EXPECT_GE(threads_or_all(0), 1);
}

}  // namespace
}  // namespace haptrial::geometry
