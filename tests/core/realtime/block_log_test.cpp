#include "core/realtime/block_log.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <deque>
#include <numeric>
#include <span>
#include <stdexcept>
#include <thread>
#include <vector>

#include "core/base/random.h"
#include "tests/support/allocation_guard.h"

namespace haptrial::realtime {
namespace {

using Log = BlockLog<std::uint64_t>;

// Drains or flushes into a vector.
std::vector<std::uint64_t> drained(Log& log) {
  std::vector<std::uint64_t> out;
  log.drain([&](auto block) { out.insert(out.end(), block.begin(), block.end()); });
  return out;
}
std::vector<std::uint64_t> flushed(Log& log) {
  std::vector<std::uint64_t> out;
  log.flush([&](auto block) { out.insert(out.end(), block.begin(), block.end()); });
  return out;
}
std::vector<std::uint64_t> numbers(std::uint64_t first, std::uint64_t end) {
  std::vector<std::uint64_t> out(end - first);
  std::iota(out.begin(), out.end(), first);
  return out;
}

TEST(BlockLogTest, RejectsSizesThatHoldNothing) {
  EXPECT_THROW(Log(0, 8), std::invalid_argument);
  EXPECT_THROW(Log(8, 1), std::invalid_argument);
  EXPECT_THROW(Log(std::size_t{1} << 40, std::size_t{1} << 40), std::invalid_argument);
}

TEST(BlockLogTest, DrainGivesFullBlocksOnly) {
  Log log(4, 4);
  for (std::uint64_t i = 0; i < 3; ++i) {
    EXPECT_TRUE(log.push(i));
  }
  EXPECT_TRUE(drained(log).empty());
  log.push(3);
  log.push(4);
  EXPECT_EQ(drained(log), numbers(0, 4));
  EXPECT_TRUE(drained(log).empty());
  EXPECT_EQ(log.size(), 1u);
}

TEST(BlockLogTest, SpansAreBlocks) {
  Log log(4, 4);
  for (std::uint64_t i = 0; i < 10; ++i) {
    log.push(i);
  }
  std::vector<std::size_t> lengths;
  const auto note = [&](std::span<const std::uint64_t> block) { lengths.push_back(block.size()); };
  EXPECT_EQ(log.flush(note), 10u);
  EXPECT_EQ(lengths, (std::vector<std::size_t>{4, 4, 2}));
}

TEST(BlockLogTest, ARecordOfTheTailIsDeliveredOnce) {
  Log log(4, 4);
  log.push(0);
  log.push(1);
  EXPECT_EQ(flushed(log), numbers(0, 2));
  EXPECT_TRUE(flushed(log).empty());
  for (std::uint64_t i = 2; i < 6; ++i) {
    log.push(i);
  }
  EXPECT_EQ(drained(log), numbers(2, 4));  // the rest of the block that was flushed in part
  EXPECT_EQ(flushed(log), numbers(4, 6));
}

TEST(BlockLogTest, AFullLogDropsCountsAndRecovers) {
  Log log(4, 3);
  for (std::uint64_t i = 0; i < 12; ++i) {
    EXPECT_TRUE(log.push(i));
  }
  EXPECT_FALSE(log.push(100));
  EXPECT_FALSE(log.push(101));
  EXPECT_EQ(log.dropped(), 2u);
  EXPECT_EQ(log.pushed(), 12u);
  EXPECT_EQ(log.size(), log.capacity());
  EXPECT_EQ(drained(log), numbers(0, 12));
  EXPECT_TRUE(log.push(12));
  EXPECT_EQ(flushed(log), numbers(12, 13));
  EXPECT_EQ(log.dropped(), 2u);
}

TEST(BlockLogTest, ABlockDeliveredInPartIsNotRecycled) {
  Log log(4, 2);
  for (std::uint64_t i = 0; i < 3; ++i) {
    log.push(i);
  }
  EXPECT_EQ(flushed(log).size(), 3u);
  for (std::uint64_t i = 3; i < 8; ++i) {
    EXPECT_TRUE(log.push(i));
  }
  EXPECT_FALSE(log.push(8));
}

TEST(BlockLogTest, ElementsAreThoseNotYetDelivered) {
  Log log(3, 3);
  for (std::uint64_t i = 0; i < 100; ++i) {
    log.push(i);
    for (std::size_t k = 0; k < log.size(); ++k) {
      ASSERT_EQ(log[k], i + 1 - log.size() + k);
      ASSERT_EQ(log.at(k), log[k]);
    }
    ASSERT_THROW(log.at(log.size()), std::out_of_range);
    ASSERT_GE(log.taken(), log.size());
    ASSERT_LT(log.taken(), log.size() + log.block_size());
    if (log.size() > 6) {
      drained(log);
    }
  }
  EXPECT_EQ(log.dropped(), 0u);
}

TEST(BlockLogTest, WhatAConsumerRefusedStaysInTheLog) {
  Log log(4, 4);
  for (std::uint64_t i = 0; i < 8; ++i) {
    log.push(i);
  }
  const auto full_disk = [](std::span<const std::uint64_t> block) {
    if (block.front() == 4) {
      throw std::runtime_error("full");
    }
  };
  EXPECT_THROW(log.drain(full_disk), std::runtime_error);
  EXPECT_EQ(drained(log), numbers(4, 8));
}

TEST(BlockLogTest, CarriesFixedSizeVectors) {
  struct Row {
    std::uint64_t sequence;
    Eigen::Vector3d position;
  };
  BlockLog<Row> log(2, 2);
  log.push({0, {1, 2, 3}});
  log.push({1, {4, 5, 6}});
  EXPECT_EQ(log[1].position, Eigen::Vector3d(4, 5, 6));
}

TEST(BlockLogTest, DoesNotAllocateAfterConstruction) {
  Log log(16, 4);
  std::uint64_t sum = 0;
  const auto add = [&](std::span<const std::uint64_t> block) {
    sum = std::accumulate(block.begin(), block.end(), sum);
  };
  const test::AllocationGuard guard;
  for (std::uint64_t i = 0; i < 1000; ++i) {
    log.push(i);
    i % 7 == 0 ? log.flush(add) : log.drain(add);
  }
  log.flush(add);
  EXPECT_EQ(guard.count(), 0u);
  EXPECT_EQ(sum, 999u * 1000 / 2);
}

// Any sizes and any order of calls behave like a bounded deque.
TEST(BlockLogTest, BehavesLikeABoundedDeque) {
  RandomStream random(11, "block_log");
  for (int trial = 0; trial < 300; ++trial) {
    Log log(1 + random.below(9), 2 + random.below(6));
    const std::size_t block = log.block_size();
    std::deque<std::uint64_t> oracle;
    std::uint64_t pushed = 0, dropped = 0, delivered = 0;
    for (int step = 0; step < 400; ++step) {
      SCOPED_TRACE(testing::Message() << "trial " << trial << ", step " << step);
      const std::uint64_t action = random.below(10);
      if (action < 8) {
        // Blocks are recycled whole: a block delivered in part still takes its room.
        const bool room = pushed - delivered / block * block < log.capacity();
        ASSERT_EQ(log.push(pushed + 1000), room);
        room ? oracle.push_back(pushed++ + 1000) : void(++dropped);
      } else {
        const bool all = action == 8;
        const std::uint64_t end = all ? pushed : std::max(delivered, pushed / block * block);
        const auto from = oracle.begin();
        const auto to = from + static_cast<std::ptrdiff_t>(end - delivered);
        ASSERT_EQ(all ? flushed(log) : drained(log), std::vector<std::uint64_t>(from, to));
        oracle.erase(from, to);
        delivered = end;
      }
      ASSERT_EQ(log.size(), oracle.size());
      ASSERT_EQ(log.pushed(), pushed);
      ASSERT_EQ(log.dropped(), dropped);
      if (!oracle.empty()) {
        const std::size_t i = random.below(oracle.size());
        ASSERT_EQ(log[i], oracle[i]);
      }
    }
  }
}

// Records of several cache lines between two threads: none lost, none twice, none torn, in order.
struct Wide {
  std::uint64_t sequence;
  std::array<std::uint64_t, 23> copies;
};

class BlockLogThreadsTest : public testing::TestWithParam<bool> {};

TEST_P(BlockLogThreadsTest, LosslessInOrderWithASlowConsumer) {
  constexpr std::uint64_t kRecords = 300000;
  const bool tail_too = GetParam();
  BlockLog<Wide> log(64, 16);
  std::atomic<bool> done{false};
  std::uint64_t expected = 0, wrong = 0, naps = 0;
  std::thread consumer([&] {
    const auto check = [&](std::span<const Wide> block) {
      for (const Wide& record : block) {
        wrong += record.sequence != expected;
        for (const auto copy : record.copies) {
          wrong += copy != expected;
        }
        ++expected;
      }
    };
    const auto take = [&] { tail_too ? log.flush(check) : log.drain(check); };
    while (!done.load(std::memory_order_acquire)) {
      take();
      if (log.size() != 0) {
        wrong += log[0].sequence != expected;
      }
      if (expected / 20000 > naps) {  // the producer meets a full log
        ++naps;
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
      }
    }
    log.flush(check);
  });
  std::uint64_t refused = 0, crowded = 0;
  Wide record{};
  while (record.sequence < kRecords) {
    crowded += log.taken() > log.capacity();
    record.copies.fill(record.sequence);
    if (log.push(record)) {
      ++record.sequence;
    } else {
      ++refused;
      std::this_thread::yield();
    }
  }
  done.store(true, std::memory_order_release);
  consumer.join();
  EXPECT_EQ(expected, kRecords);
  EXPECT_EQ(wrong, 0u);
  EXPECT_EQ(log.dropped(), refused);
  EXPECT_EQ(crowded, 0u);
  EXPECT_GT(refused, 0u);
  EXPECT_GT(naps, 1u);
}

INSTANTIATE_TEST_SUITE_P(DrainAndFlush, BlockLogThreadsTest, testing::Bool());

}  // namespace
}  // namespace haptrial::realtime
