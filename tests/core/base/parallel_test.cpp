#include "core/base/parallel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace haptrial {
namespace {

TEST(ParallelForTest, DoesEachItemOnce) {
  for (const int threads : {-1, 1, 2, 7}) {
    std::vector<std::atomic<int>> done(1000);
    parallel_for(done.size(), threads, [&](std::size_t i) { ++done[i]; });
    for (const auto& times : done) {
      EXPECT_EQ(times, 1);
    }
  }
  parallel_for(0, 4, [](std::size_t) { FAIL() << "there is nothing to do"; });
}

TEST(ParallelForTest, ThrowsWhatAnItemThrows) {
  std::atomic<int> done{0};
  const auto run = [&] {
    parallel_for(100000, 3, [&](std::size_t i) {
      if (i == 5) {
        throw std::runtime_error("five");
      }
      ++done;
    });
  };
  EXPECT_THROW(run(), std::runtime_error);
  EXPECT_LT(done, 100000);
}

TEST(ParallelForTest, ThrowsTheSameOnAnyNumberOfThreads) {
  for (const int threads : {1, 2, 5}) {
    for (int again = 0; again < 20; ++again) {
      std::string told;
      try {
        parallel_for(100, threads, [](std::size_t i) {
          if (i >= 7 && i <= 9) {
            std::this_thread::sleep_for(std::chrono::microseconds(200 * (10 - i)));
            throw std::runtime_error(std::to_string(i));
          }
        });
      } catch (const std::runtime_error& error) {
        told = error.what();
      }
      EXPECT_EQ(told, "7") << threads;
    }
  }
}

TEST(InGroupsTest, CoversEachItemOnceWithAWorkForEachThread) {
  for (const int jobs : {1, 3}) {
    std::atomic<int> made{0};
    std::vector<std::atomic<int>> done(10);
    in_groups(done.size(), 4, jobs, [&] {
      ++made;
      return [&, own = std::make_unique<int>(0)](std::size_t first, std::size_t count) {
        EXPECT_EQ(first % 4, 0U);
        EXPECT_EQ(count, first == 8 ? 2U : 4U);
        for (std::size_t i = first; i < first + count; ++i) {
          ++done[i];
        }
      };
    });
    for (const auto& times : done) {
      EXPECT_EQ(times, 1);
    }
    EXPECT_LE(made, jobs);
  }
  EXPECT_THROW(in_groups(1, 1, 0, [] { return [](std::size_t, std::size_t) {}; }),
               std::invalid_argument);
}

TEST(SharedWorkTest, CanBeWatchedAndLeft) {
  std::atomic<bool> go{false};
  std::atomic<int> begun{0};
  std::jthread release;
  {
    SharedWork shared(1'000'000, 2, [&] {
      return [&](std::size_t) {
        ++begun;
        while (!go) {
          std::this_thread::yield();
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
      };
    });
    EXPECT_FALSE(shared.ended_within(std::chrono::milliseconds(5)));
    release = std::jthread([&] {
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
      go = true;
    });
  }
  EXPECT_LT(begun, 1'000'000);
}

TEST(SharedWorkTest, EndsWithItsItems) {
  std::atomic<int> done{0};
  SharedWork shared(50, 3, [&] { return [&](std::size_t) { ++done; }; });
  while (!shared.ended_within(std::chrono::milliseconds(1))) {
  }
  shared.finish();
  EXPECT_EQ(done, 50);
}

TEST(ParallelForTest, KnowsTheProcessors) {
  EXPECT_EQ(threads_or_all(3), 3);
  EXPECT_GE(threads_or_all(0), 1);
}

}  // namespace
}  // namespace haptrial
