#include "core/realtime/latest_value.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <array>
#include <atomic>
#include <cstdint>
#include <thread>

#include "tests/support/allocation_guard.h"

namespace haptrial::realtime {
namespace {

TEST(LatestValueTest, NothingWrittenReadsNothing) {
  LatestValue<int> channel;
  int value = 7;
  EXPECT_FALSE(channel.read(value));
  EXPECT_EQ(value, 7);
}

TEST(LatestValueTest, ReadsTheNewestOnce) {
  LatestValue<int> channel;
  int value = 0;
  for (int newest = 1; newest < 20; ++newest) {
    for (int i = 0; i < newest % 5; ++i) {
      channel.write(-i);
    }
    channel.write(newest);
    EXPECT_TRUE(channel.read(value));
    EXPECT_EQ(value, newest);
    EXPECT_FALSE(channel.read(value));
    EXPECT_EQ(value, newest);
  }
}

TEST(LatestValueTest, CarriesFixedSizeVectorsWithoutAllocation) {
  LatestValue<Eigen::Vector3d> channel;
  Eigen::Vector3d value;
  const test::AllocationGuard guard;
  channel.write({1, 2, 3});
  EXPECT_TRUE(channel.read(value));
  EXPECT_EQ(value, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(guard.count(), 0u);
}

// Values of several cache lines, written and read as fast as two threads can: every one that is
// read is whole, they only get newer, and the last one written is the last one read.
TEST(LatestValueTest, ValuesStayWholeBetweenThreads) {
  using Value = std::array<std::uint64_t, 40>;
  LatestValue<Value> channel;
  std::atomic<bool> enough{false};
  std::uint64_t last = 0;
  std::thread writer([&] {
    Value value;
    while (!enough.load(std::memory_order_relaxed)) {
      value.fill(++last);
      channel.write(value);
    }
  });
  std::uint64_t torn = 0, backwards = 0, newest = 0;
  Value value{};
  const auto check = [&] {
    backwards += value[0] <= newest;
    newest = value[0];
    for (const auto v : value) {
      torn += v != newest;
    }
  };
  for (int reads = 0; reads < 20000;) {
    if (channel.read(value)) {
      check();
      ++reads;
    }
  }
  enough = true;
  writer.join();
  if (channel.read(value)) {
    check();
  }
  EXPECT_EQ(newest, last);
  EXPECT_EQ(torn, 0u);
  EXPECT_EQ(backwards, 0u);
}

}  // namespace
}  // namespace haptrial::realtime
