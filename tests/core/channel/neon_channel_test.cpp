// The kind `neon` against a phone's interface over HTTP.

#include "core/channel/channel_kinds.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <optional>
#include <vector>

#include "core/base/error.h"
#include "core/base/random.h"
#include "tests/support/channel_run.h"
#include "tests/support/free_port.h"
#include "tests/support/message_of.h"
#include "tests/support/stand_in_neon.h"

namespace haptrial::channel {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::SizeIs;

std::string neon_at(int port, const std::string& keys = "") {
  return fmt::format(
      "[channels.eyes]\nkind = \"neon\"\nhost = \"127.0.0.1\"\nport = {}\nrate = 50\n{}", port,
      keys);
}

std::vector<std::string> texts_of(const std::vector<IncidentRow>& rows) {
  std::vector<std::string> texts;
  for (const IncidentRow& each : rows) {
    texts.push_back(each.text);
  }
  return texts;
}

TEST(NeonChannelTest, StatesComeAtTheTimeOfTheAnswer) {
  test::StandInNeon phone;
  test::ChannelRun run(neon_at(phone.port()));
  ASSERT_EQ(run.channel().wait_until_open(), "");
  RandomStream random(2, "network");
  std::vector<double> truth;
  std::vector<int> battery;
  phone.when_asked([&] {  // the way there and the way back take their time
    run.set_now(run.now() + 0.03 * random.uniform());
    truth.push_back(run.now());
    battery.push_back(phone.state().battery = static_cast<int>(truth.size()));
    phone.state().recorded_ns = 1'000'000LL * battery.back();
    run.set_now(run.now() + 0.03 * random.uniform());
  });
  phone.change([](auto& state) { state.recording = true; });
  run.rows(40);
  phone.when_asked({});
  auto rows = run.rows(40);
  const auto first = std::ranges::find(rows, 1.0, [](const ChannelRow& r) { return r.values[0]; });
  ASSERT_NE(first, rows.end());
  rows.erase(rows.begin(), first);
  rows.resize(std::min(rows.size(), truth.size()));
  for (std::size_t i = 0; i < rows.size(); ++i) {
    ASSERT_EQ(rows[i].values[0], battery[i]);
    ASSERT_NEAR(rows[i].values[1], 101.001773056, 1e-9);
    ASSERT_EQ(rows[i].values[2], 1.0);
    ASSERT_NEAR(rows[i].values[3], 1e-3 * battery[i], 1e-12);
  }
  EXPECT_GT(rows.size(), 30u);
  EXPECT_GT(test::share_within(rows, truth), 0.95);
}

TEST(NeonChannelTest, WhatChangesIsTold) {
  test::StandInNeon phone;
  test::ChannelRun run(neon_at(phone.port()));
  EXPECT_THAT(
      texts_of(run.incidents(Incident::kStatus, 4)),
      ElementsAre("battery: OK", "memory: OK", "recording: none", "sensor gaze DIRECT: connected"));
  phone.change([](auto& state) {
    state.battery_state = "LOW";
    state.gaze_connected = false;
  });
  const auto told = run.incidents(Incident::kStatus, 6);
  EXPECT_EQ(told[4].text, "battery: LOW");
  EXPECT_EQ(told[5].text, "sensor gaze DIRECT: not connected");
  EXPECT_EQ(told[5].amount, 1.0) << "a fault";
  phone.change([](auto& state) { state.recording = true; });
  EXPECT_EQ(run.incidents(Incident::kStatus, 7)[6].text, "recording: START r-1");
  phone.change([](auto& state) { state.recording = false; });
  EXPECT_EQ(run.incidents(Incident::kStatus, 8)[7].text, "recording: none");
  EXPECT_EQ(run.rows(run.channel().log().pushed() + 1).back().values[2], 0.0);
}

TEST(NeonChannelTest, AnswersThatAreNoneAreToldAndThePhoneIsFoundAgain) {
  auto phone = std::make_unique<test::StandInNeon>();
  const int port = phone->port();
  test::ChannelRun run(neon_at(port, "patience = 2\n"));
  run.rows(1);
  phone->answer_with("{\"message\": \"Success\", \"result\": [{\"model\": 3}]}");
  EXPECT_EQ(run.incidents(Incident::kMalformed, 1)[0].amount, 48.0);
  phone->answer_with("<html>");
  test::wait_until([&] { return run.of_kind(Incident::kMalformed).back().amount == 6.0; });
  run.of_kind(Incident::kStatus);
  phone->answer_with("{\"message\": \"Too hot\"}", 503);
  const auto hot = run.incidents(Incident::kStatus, 5)[4];
  EXPECT_EQ(hot.amount, 503.0);
  EXPECT_EQ(hot.text, "no answer: HTTP 503: \"Too hot\"");
  phone.reset();
  const auto gone = run.incidents(Incident::kStatus, 6)[5];
  EXPECT_THAT(gone.text, HasSubstr("no answer: "));
  EXPECT_EQ(gone.amount, 1.0) << "a fault, although HTTP has no number for it";
  run.set_now(2.5);
  EXPECT_THAT(run.incidents(Incident::kLost, 1)[0].text, HasSubstr("no data come any more"));
  phone = std::make_unique<test::StandInNeon>(port);
  run.incidents(Incident::kBack, 1);
  EXPECT_TRUE(run.channel().seen().live);
}

TEST(NeonChannelTest, ARecordingBeginsAndEndsWithTheChannel) {
  test::StandInNeon phone;
  test::ChannelRun run(neon_at(phone.port(), "record = true\n"));
  ASSERT_EQ(run.channel().wait_until_open(), "");
  EXPECT_THAT(phone.posts(), ElementsAre("recording:start"));
  EXPECT_EQ(run.rows(1)[0].values[2], 1.0);
  run.close();
  EXPECT_THAT(phone.posts(), ElementsAre("recording:start", "recording:stop_and_save"));
  test::ChannelRun only(neon_at(phone.port()));
  only.rows(1);
  only.close();
  EXPECT_THAT(phone.posts(), SizeIs(2)) << "not without `record`";
  phone.change([](auto& state) { state.recording = true; });
  test::ChannelRun second(neon_at(phone.port(), "record = true\n"));
  EXPECT_THAT(second.channel().wait_until_open(),
              HasSubstr("begins no recording: HTTP 500: \"Already recording\""));
}

TEST(NeonChannelTest, ARecordingThatEndsOnThePhoneIsALossAndBeginsAnew) {
  test::StandInNeon phone;
  test::ChannelRun run(neon_at(phone.port(), "record = true\n"));
  run.rows(1);
  phone.change([](auto& state) { state.recording = false; });
  EXPECT_THAT(run.incidents(Incident::kLost, 1)[0].text,
              HasSubstr("the recording on the phone has ended"));
  run.incidents(Incident::kBack, 1);
  EXPECT_THAT(phone.posts(), ElementsAre("recording:start", "recording:start"));
  EXPECT_EQ(run.rows(run.channel().log().pushed() + 1).back().values[2], 1.0);
}

TEST(NeonChannelTest, WithoutAPhoneOrWithAMistakeThereIsASentence) {
  test::ChannelRun run(neon_at(test::free_port()));
  EXPECT_THAT(run.channel().wait_until_open(), HasSubstr("gives no state of a Neon: "));
  EXPECT_THAT(test::message_of<InputError>([] {
                test::channels_of("[channels.a]\nkind = \"neon\"\nhost = \"http://neon.local\"");
              }),
              HasSubstr("without http:// and path"));
  EXPECT_EQ(test::channels_of("[channels.a]\nkind = \"neon\"\nrate = 0.5").at(0).plan.patience,
            8.0);
}

}  // namespace
}  // namespace haptrial::channel
