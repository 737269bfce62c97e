// Bytes that are put in come out once and in order, whatever the network does to the messages.

#include "core/tutoring/reliable_stream.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <utility>
#include <vector>

#include "core/tutoring/simulated_channel.h"
#include "tests/support/allocation_guard.h"

namespace haptrial::tutoring::reliable_stream_test {
namespace {

constexpr std::int64_t kMillisecond = 1'000'000;

/// Gives numbers as long as there are any, and keeps those it takes.
struct Numbers final : ReliablePayload {
  explicit Numbers(std::uint32_t give) : last(give) { came.reserve(100'000); }
  std::size_t give(std::span<std::byte> room) noexcept override {
    std::size_t used = 0;
    for (; ready > 0 && given < last && used + 4 <= room.size(); used += 4, --ready) {
      ++given;
      std::memcpy(room.data() + used, &given, 4);
    }
    return used;
  }
  void take(std::span<const std::byte> bytes) noexcept override {
    for (; bytes.size() >= 4; bytes = bytes.subspan(4)) {
      std::uint32_t number = 0;
      std::memcpy(&number, bytes.data(), 4);
      came.push_back(number);
    }
  }

  std::uint32_t last;
  std::uint32_t given{0};
  int ready{0};  // to be given in this tick
  std::vector<std::uint32_t> came;
};

struct Two {
  explicit Two(const ChannelConditions& network, std::uint64_t seed = 1)
      : there(network, seed, "there"),
        back(network, seed, "back"),
        round_trip(static_cast<std::int64_t>(2e9 * network.delay)) {}

  void tick() {
    one(a, numbers, back, there);
    one(b, none, there, back);
    ++now;
  }
  void one(ReliableStream& stream, Numbers& payload, SimulatedChannel& in, SimulatedChannel& out) {
    while (const auto bytes = in.receive(1e-3 * now)) {
      stream.hear(decode(*bytes)->stream);
    }
    stream.deliver(payload);
    payload.ready = std::min(payload.ready + 15, 100'000);  // three fit for each two ticks
    TickMessage message;
    message.sequence = static_cast<std::uint64_t>(now) + 1;
    if (stream.wants(payload, now * kMillisecond, round_trip)) {
      stream.fill(message.stream, now * kMillisecond);
      out.send(encode(message), 1e-3 * now);
      ++messages;
    }
  }

  SimulatedChannel there, back;
  std::int64_t round_trip;
  ReliableStream a, b;
  Numbers numbers{60'000};
  Numbers none{0};
  int now{0};
  int messages{0};
};

TEST(ReliableStreamTest, EverythingComesOnceAndInOrder) {
  const ChannelConditions networks[] = {
      {},
      {.delay = 0.2, .jitter = 0.02, .loss = 0.05, .duplication = 0.02, .reordering = 0.05},
      {.delay = 0.01, .jitter = 0.05, .loss = 0.3, .duplication = 0.3, .reordering = 1.0},
      {.delay = 0.05, .loss = 0.6}};
  for (const ChannelConditions& network : networks) {
    SCOPED_TRACE(testing::PrintToString(std::pair(network.delay, network.loss)));
    Two two(network);
    for (int i = 0; i < 60'000 && !(two.numbers.given == 60'000 && two.a.all_heard()); ++i) {
      two.tick();
    }
    EXPECT_TRUE(two.a.all_heard());
    ASSERT_EQ(two.none.came.size(), 60'000u);
    for (std::uint32_t i = 0; i < 60'000; ++i) {
      ASSERT_EQ(two.none.came[i], i + 1);
    }
    EXPECT_LE(two.a.given() + two.a.again(), 4.0 / (1.0 - network.loss) * 60'000 / 15);
  }
}

TEST(ReliableStreamTest, APerfectNetworkSendsNothingTwiceAndThenNothing) {
  Two two({.delay = 0.02});
  for (int i = 0; i < 5000; ++i) {
    two.tick();
  }
  EXPECT_EQ(two.a.again(), 0u);
  EXPECT_EQ(two.none.came.size(), 60'000u);
  const int messages = two.messages;
  for (int i = 0; i < 100; ++i) {
    two.tick();
  }
  EXPECT_EQ(two.messages, messages);
}

TEST(ReliableStreamTest, ACutIsMadeUpForWhenTheNetworkIsBack) {
  Two two({.delay = 0.02});
  for (int i = 0; i < 4000; ++i) {
    two.there.change({.delay = 0.02, .loss = i > 200 && i < 3000 ? 1.0 : 0.0});
    two.tick();
  }
  for (int i = 0; i < 10'000 && two.none.came.size() < 60'000; ++i) {
    two.tick();
  }
  ASSERT_EQ(two.none.came.size(), 60'000u);
  EXPECT_TRUE(std::ranges::is_sorted(two.none.came));
}

TEST(ReliableStreamTest, DoesNotAllocate) {
  Two two({.delay = 0.02, .jitter = 0.02, .loss = 0.1});
  const test::AllocationGuard guard;
  for (int i = 0; i < 1000; ++i) {
    two.tick();
  }
  EXPECT_EQ(guard.count(), 0u);
}

TEST(ReliableStreamTest, AMessageWithoutAStreamIsAsShortAsEver) {
  TickMessage message;
  message.sequence = 1;
  EXPECT_EQ(encode(message).size(), kTickBytes);
  message.stream.beyond[3] = 1;
  EXPECT_EQ(encode(message).size(), kStreamTickBytes);
  EXPECT_EQ(decode(encode(message)), message);
  message.stream.size = StreamPart::kMost + 1;
  EXPECT_FALSE(decode(encode(message)));
}

}  // namespace
}  // namespace haptrial::tutoring::reliable_stream_test
