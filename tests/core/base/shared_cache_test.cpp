#include "core/base/shared_cache.h"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <thread>
#include <vector>

namespace haptrial {
namespace {

auto counting(std::atomic<int>& made, int value) {
  return [&made, value] {
    ++made;
    return std::make_shared<const int>(value);
  };
}

TEST(SharedCacheTest, TheSameKeyIsMadeOnceAndTheOldestLeaves) {
  SharedCache<int, int> kept(2);
  std::atomic<int> made{0};
  const auto first = kept.get(1, counting(made, 10));
  kept.get(2, counting(made, 20));
  EXPECT_EQ(kept.get(1, counting(made, 11)), first) << "and it is the newest now";
  EXPECT_EQ(made, 2);
  kept.get(3, counting(made, 30));  // 2 leaves
  EXPECT_EQ(*kept.get(1, counting(made, 12)), 10);
  EXPECT_EQ(*kept.get(2, counting(made, 21)), 21);
  EXPECT_EQ(*first, 10) << "whoever has a value keeps it";
}

TEST(SharedCacheTest, ThreadsThatAskTogetherShareOneValue) {
  SharedCache<int, int> kept(1);
  std::atomic<int> made{0};
  std::vector<SharedCache<int, int>::Shared> found(8);
  std::vector<std::thread> threads;
  for (auto& each : found) {
    threads.emplace_back([&] { each = kept.get(7, counting(made, 70)); });
  }
  for (std::thread& thread : threads) {
    thread.join();
  }
  EXPECT_EQ(made, 1);
  for (const auto& each : found) {
    EXPECT_EQ(each, found.front());
  }
}

TEST(SharedCacheTest, AFailureIsTheSameForAll) {
  SharedCache<int, int> kept(1);
  const auto fails = []() -> std::shared_ptr<const int> { throw std::runtime_error("no bone"); };
  EXPECT_THROW(kept.get(1, fails), std::runtime_error);
  std::atomic<int> made{0};
  EXPECT_THROW(kept.get(1, counting(made, 1)), std::runtime_error);
  EXPECT_EQ(made, 0);
}

}  // namespace
}  // namespace haptrial
