// Onsets as events of a Neon's recording, over a stand-in of the phone.

#include "core/stream/neon_events.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <thread>

#include "tests/support/free_port.h"
#include "tests/support/stand_in_neon.h"

namespace haptrial::markers {
namespace {

using testing::HasSubstr;

constexpr std::int64_t kSecond = 1'000'000'000;  // [ns]

/// A clock of a session that has run for ten seconds when the test begins.
std::int64_t session_now() {
  static const auto kBegin = std::chrono::steady_clock::now() - std::chrono::seconds(10);
  return std::chrono::nanoseconds(std::chrono::steady_clock::now() - kBegin).count();
}

TimedOnset stage_onset(std::uint64_t number, std::int64_t time_ns) {
  return {{record::MarkerOf::kStage}, number, 10 * number, time_ns};
}

std::vector<NeonEvent> all_of(NeonEvents& events, std::size_t count) {
  std::vector<NeonEvent> sent;
  while (sent.size() < count) {
    for (const NeonEvent& each : events.take_sent()) {
      sent.push_back(each);
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return sent;
}

std::string address_of(int port) { return "127.0.0.1:" + std::to_string(port); }

TEST(NeonEventsTest, AnEventHasTheTimeOfItsTickRatherThanThatOfItsSending) {
  test::StandInNeon phone;
  NeonEvents events(address_of(phone.port()), session_now);
  const std::int64_t tick = session_now() - 3 * kSecond;
  const auto wall = std::chrono::nanoseconds(std::chrono::system_clock::now().time_since_epoch() -
                                             std::chrono::seconds(3));
  events.send(stage_onset(1, tick), "stage press");
  events.send(stage_onset(2, tick + 5'000'000), "response yes");
  const auto sent = all_of(events, 2);
  ASSERT_EQ(phone.events().size(), 2u);
  const auto first = nlohmann::json::parse(phone.events()[0]);
  const auto second = nlohmann::json::parse(phone.events()[1]);
  EXPECT_EQ(first["name"], "stage press");
  EXPECT_EQ(second["name"], "response yes");
  // The two clocks are read one after the other; a busy machine may pause in between.
  EXPECT_NEAR(first["timestamp"].get<double>(), static_cast<double>(wall.count()), 1e9);
  EXPECT_NEAR(second["timestamp"].get<double>() - first["timestamp"].get<double>(), 5e6, 1e9);
  for (const NeonEvent& each : sent) {
    EXPECT_GT(each.taken_ns, tick);
  }
  EXPECT_TRUE(events.all_sent());
  EXPECT_EQ(events.trouble(), "");
}

TEST(NeonEventsTest, APhoneThatIsAwayIsSaidOnceAndEveryEventCounts) {
  const int port = test::free_port();
  NeonEvents events(address_of(port), session_now);
  events.send(stage_onset(1, 0), "trial 1");
  events.send(stage_onset(2, 0), "trial 2");
  for (const NeonEvent& each : all_of(events, 2)) {
    EXPECT_EQ(each.taken_ns, -1);
  }
  EXPECT_THAT(events.trouble(),
              HasSubstr("the Neon at 127.0.0.1:" + std::to_string(port) + " did not answer"));
}

TEST(NeonEventsTest, ARefusalIsNoEvent) {
  test::StandInNeon phone;
  phone.answer_with("", 500);
  NeonEvents events(address_of(phone.port()), session_now);
  events.send(stage_onset(1, 0), "trial 1");
  EXPECT_EQ(all_of(events, 1)[0].taken_ns, -1);
  EXPECT_THAT(events.trouble(), HasSubstr("refused an event (status 500)"));
}

TEST(NeonEventsTest, WhatIsGivenUpCountsAsNotTaken) {
  NeonEvents events("192.0.2.1", session_now);  // an address that nobody has
  for (std::uint64_t number = 1; number <= 5; ++number) {
    events.send(stage_onset(number, 0), "trial");
  }
  events.give_up();
  EXPECT_EQ(all_of(events, 5).size(), 5u);
  EXPECT_TRUE(events.all_sent());
}

}  // namespace
}  // namespace haptrial::markers
