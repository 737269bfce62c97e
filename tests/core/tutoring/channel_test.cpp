// Messages, what a network does to them, and what is made of the times at which they come.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>
#include <vector>

#include "core/tutoring/clock_offset.h"
#include "core/tutoring/jitter_buffer.h"
#include "core/tutoring/sequence_window.h"
#include "core/tutoring/simulated_channel.h"
#include "core/tutoring/tick_message.h"
#include "tests/support/allocation_guard.h"

namespace haptrial::tutoring {
namespace {

TickMessage message(std::uint64_t sequence) {
  TickMessage m;
  m.sequence = sequence;
  m.sent_ns = static_cast<std::int64_t>(sequence) * 1'000'000;
  m.position = {0.01, -0.02, 1e-300};
  m.force = {-1.5, 0.0, 3.25};
  m.energy = 0.125;
  m.lead = 0.75;
  m.buttons = 5;
  m.flags = kEngaged | kStop;
  return m;
}

TEST(TickMessageTest, ComesBackToTheBit) {
  const TickMessage m = message(77);
  const auto back = decode(encode(m));
  ASSERT_TRUE(back.has_value());
  EXPECT_EQ(*back, m);
}

TEST(TickMessageTest, WhatMakesNoSenseIsRefused) {
  const TickBytes bytes = encode(message(1));
  EXPECT_FALSE(decode(std::span(bytes).first(bytes.size() - 1)));
  EXPECT_FALSE(decode({}));
  TickMessage wrong = message(1);
  wrong.force.y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(decode(encode(wrong)));
  wrong = message(1);
  wrong.lead = 1.5;
  EXPECT_FALSE(decode(encode(wrong)));
  wrong = message(1);
  wrong.flags = 1u << 9;
  EXPECT_FALSE(decode(encode(wrong)));
}

TEST(SequenceWindowTest, TakesEachNumberOnceAsASetWould) {
  RandomStream random(1, "window");
  SequenceWindow window;
  std::set<std::uint64_t> seen;
  std::uint64_t highest = 0;
  for (int i = 0; i < 200'000; ++i) {
    const std::uint64_t about = highest + 3;
    const std::uint64_t sequence = about - std::min(about, random.below(i % 100 == 0 ? 3000 : 40));
    const bool too_old = highest >= sequence + SequenceWindow::kSpan;
    const bool fresh = sequence > 0 && !too_old && !seen.contains(sequence);
    ASSERT_EQ(window.accept(sequence), fresh) << sequence << " after " << highest;
    if (fresh) {
      seen.insert(sequence);
      highest = std::max(highest, sequence);
    }
  }
  EXPECT_EQ(window.accepted(), seen.size());
  EXPECT_EQ(window.missing(), highest - seen.size());
}

TEST(SequenceWindowTest, AJumpForgetsWhatWasSeenBefore) {
  SequenceWindow window;
  EXPECT_TRUE(window.accept(5));
  EXPECT_TRUE(window.accept(5 + 10 * SequenceWindow::kSpan));
  EXPECT_TRUE(window.accept(6 + 9 * SequenceWindow::kSpan)) << "its place had another's mark";
  EXPECT_FALSE(window.accept(5)) << "too old to tell";
}

struct Arrivals {
  std::vector<std::uint64_t> sequence;
  std::vector<double> delay;  // [s]
};

Arrivals through(const ChannelConditions& conditions, int messages, std::uint64_t seed = 1) {
  SimulatedChannel channel(conditions, seed, "test");
  Arrivals arrivals;
  for (int tick = 1; tick < messages + 5000; ++tick) {
    const double now = 1e-3 * tick;
    if (tick <= messages) {
      channel.send(encode(message(static_cast<std::uint64_t>(tick))), now);
    }
    while (const auto bytes = channel.receive(now)) {
      arrivals.sequence.push_back(decode(*bytes)->sequence);
      arrivals.delay.push_back(now - 1e-9 * static_cast<double>(decode(*bytes)->sent_ns));
    }
  }
  return arrivals;
}

TEST(SimulatedChannelTest, AnEmptyWireOnlyDelays) {
  const Arrivals a = through({0.05}, 1000);
  ASSERT_EQ(a.sequence.size(), 1000u);
  for (std::size_t i = 0; i < a.delay.size(); ++i) {
    ASSERT_EQ(a.sequence[i], i + 1);
    ASSERT_NEAR(a.delay[i], 0.05, 1.01e-3);
  }
}

/// Standard deviations from a binomial's mean.
double deviations(double counted, double n, double p) {
  return (counted - n * p) / std::sqrt(n * p * (1.0 - p));
}

TEST(SimulatedChannelTest, SharesAreThoseAskedFor) {
  constexpr int kMessages = 100'000;
  ChannelConditions c;
  c.loss = 0.05;
  const auto lossy = through(c, kMessages, 2);
  EXPECT_LT(
      std::abs(deviations(static_cast<double>(kMessages - lossy.sequence.size()), kMessages, 0.05)),
      4.0);
  c = {};
  c.duplication = 0.03;
  const auto doubled = through(c, kMessages, 2);
  EXPECT_LT(std::abs(deviations(static_cast<double>(doubled.sequence.size() - kMessages), kMessages,
                                0.03)),
            4.0);
}

TEST(SimulatedChannelTest, JitterKeepsTheOrderUnlessAskedOtherwise) {
  ChannelConditions c;
  c.delay = 0.02;
  c.jitter = 0.005;
  const auto ordered = through(c, 20'000);
  EXPECT_TRUE(std::is_sorted(ordered.sequence.begin(), ordered.sequence.end()));
  c.reordering = 1.0;
  const auto free = through(c, 20'000);
  EXPECT_FALSE(std::is_sorted(free.sequence.begin(), free.sequence.end()));
  double mean = 0.0;
  for (const double delay : free.delay) {
    mean += delay / static_cast<double>(free.delay.size());
  }
  EXPECT_NEAR(mean, 0.02 + 0.005 + 0.0005, 3e-4) << "and half a tick until it is asked for";
}

TEST(SimulatedChannelTest, BandwidthIsShared) {
  ChannelConditions c;
  const double bytes = static_cast<double>(kTickBytes + SimulatedChannel::kOverhead);
  c.bandwidth = 500.0 * bytes;  // half of what a thousand a second need
  SimulatedChannel channel(c, 1, "narrow");
  int arrived = 0;
  for (int tick = 1; tick <= 2000; ++tick) {
    channel.send(encode(message(1)), 1e-3 * tick);
    while (channel.receive(1e-3 * tick)) {
      ++arrived;
    }
  }
  EXPECT_NEAR(arrived, 1000, 2);
}

TEST(SimulatedChannelTest, TheSameSeedIsTheSameNetworkAndMemoryIsBounded) {
  const ChannelConditions c{0.01, 0.01, 0.1, 0.1, 0.3, 0.0};
  EXPECT_EQ(through(c, 5000, 3).sequence, through(c, 5000, 3).sequence);
  EXPECT_NE(through(c, 5000, 3).sequence, through(c, 5000, 4).sequence);
  SimulatedChannel slow({1e3}, 1, "slow");
  const test::AllocationGuard guard;
  for (std::size_t i = 0; i < SimulatedChannel::kMost + 10; ++i) {
    slow.send(encode(message(1)), 0.0);
  }
  EXPECT_EQ(slow.under_way(), SimulatedChannel::kMost);
  EXPECT_EQ(slow.lost(), 10u);
  EXPECT_EQ(guard.count(), 0u);
}

TEST(ClockOffsetTest, FindsOffsetAndDriftThroughJitter) {
  constexpr std::int64_t kEpoch = 1'700'000'000'000'000'000;  // a clock that began in 1970
  constexpr double kDrift = 50e-6;
  constexpr std::int64_t kApart = -3'141'592'653;
  const auto partners = [&](std::int64_t own) {
    return own + kApart + std::llround(kDrift * static_cast<double>(own - kEpoch));
  };
  RandomStream random(1, "clock");
  const auto way = [&] {  // [ns]
    return 10'000'000 + static_cast<std::int64_t>(-5e6 * std::log1p(-random.uniform()));
  };
  ClockOffset clock;
  EXPECT_FALSE(clock.known());
  for (int tick = 0; tick < 60'000; ++tick) {
    const std::int64_t sent = kEpoch + tick * 1'000'000LL;
    const std::int64_t came = sent + way();
    const std::int64_t left = came + 2'000'000;
    clock.add(sent, partners(came), partners(left), left + way());
  }
  const std::int64_t now = kEpoch + 60'000'000'000;
  EXPECT_NEAR(static_cast<double>(clock.offset(now) - (partners(now) - now)), 0.0, 0.2e6);
  EXPECT_NEAR(clock.drift(), kDrift, 3e-6);
  EXPECT_GE(clock.round_trip(), 20'000'000);
}

TEST(ClockOffsetTest, AUnevenWayIsWrongByHalfTheDifference) {
  ClockOffset clock;
  for (int i = 0; i < 5000; ++i) {
    const std::int64_t sent = i * 1'000'000LL;
    clock.add(sent, sent + 30'000'000, sent + 30'000'000, sent + 40'000'000);
  }
  EXPECT_NEAR(static_cast<double>(clock.offset(5'000'000'000)), 10e6, 1.0);
}

/// A network that is as quick both ways becomes quicker or slower, at any time of a second: answers
/// that went one way and came the other are no measure of the clocks.
TEST(ClockOffsetTest, AChangeOfTheNetworkIsNoChangeOfTheClocks) {
  for (const std::int64_t before : {40'000'000LL, 22'000'000LL, 200'000'000LL}) {
    for (const std::int64_t after : {22'000'000LL, 40'000'000LL, 30'000'000LL}) {
      for (std::int64_t phase = 0; phase < 1'000'000'000; phase += 7'000'000) {
        const std::int64_t change = 5'000'000'000 + phase;
        const auto way = [&](std::int64_t at) { return at < change ? before : after; };
        ClockOffset clock;
        std::int64_t worst = 0;
        for (std::int64_t sent = 0; sent < 12'000'000'000; sent += 5'000'000) {
          const std::int64_t came = sent + way(sent);
          const std::int64_t now = came + way(came);
          clock.add(sent, came, came, now);
          worst = std::max(worst, std::abs(clock.offset(now)));
        }
        EXPECT_EQ(worst, 0) << before << ", " << after << ", " << phase;
      }
    }
  }
}

/// The quickest answer of each second is another one each time; the clocks are compared all the
/// same.
TEST(ClockOffsetTest, ARestlessNetworkIsFollowedToo) {
  constexpr std::int64_t kApart = 1'000'000'000;
  ClockOffset clock;
  for (std::int64_t sent = 0; sent < 60'000'000'000; sent += 5'000'000) {
    const std::int64_t way = 20'000'000 + 30'000'000 * (sent / 1'000'000'000 % 2);
    const std::int64_t drifted = kApart + sent / 10'000;
    clock.add(sent, sent + way + drifted, sent + way + drifted, sent + 2 * way);
  }
  EXPECT_NEAR(clock.drift(), 1e-4, 1e-5);
}

TEST(JitterBufferTest, GivesOutEvenlyWhatCameUnevenly) {
  SimulatedChannel channel({0.03, 0.01, 0.0, 0.0, 1.0, 0.0}, 5, "jitter");
  JitterBuffer buffer(0.01, 200'000'000);
  std::uint64_t last = 0;
  int uneven = 0;
  int after = 0;
  for (int tick = 1; tick < 20'000; ++tick) {
    channel.send(encode(message(static_cast<std::uint64_t>(tick))), 1e-3 * tick);
    while (const auto bytes = channel.receive(1e-3 * tick)) {
      buffer.put(*decode(*bytes), tick * 1'000'000LL);
    }
    const TickMessage* out = buffer.take(tick * 1'000'000LL);
    if (out == nullptr) {
      continue;
    }
    ASSERT_GE(out->sequence, last);
    if (tick > 2000) {
      ++after;
      uneven += out->sequence == last + 1 ? 0 : 1;
    }
    last = out->sequence;
  }
  EXPECT_LT(uneven, after / 20);
  // 99 % of exponential delays of 10 ms are below 46 ms.
  EXPECT_NEAR(1e-6 * static_cast<double>(buffer.delay()), 46.0, 12.0);
}

TEST(JitterBufferTest, WithoutJitterItCostsNothing) {
  JitterBuffer buffer(0.01, 200'000'000);
  for (int tick = 1; tick < 3000; ++tick) {
    buffer.put(message(static_cast<std::uint64_t>(tick)), tick * 1'000'000LL + 500'000);
    ASSERT_EQ(buffer.take(tick * 1'000'000LL + 500'000)->sequence,
              static_cast<std::uint64_t>(tick));
  }
  EXPECT_EQ(buffer.delay(), 0);
}

}  // namespace
}  // namespace haptrial::tutoring
