#include "core/channel/channel_kinds.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <thread>
#include <vector>

#include "core/base/random.h"
#include "tests/support/channel_run.h"
#include "tests/support/message_of.h"
#include "tests/support/stand_in_vrpn.h"

namespace haptrial::channel {
namespace {

using test::ChannelRun;
using test::StandInVrpn;
using test::VrpnPose;
using ::testing::HasSubstr;

constexpr double kStart = 1'700'000'000.0;  // of the server's clock [s]
constexpr double kGreeting = -1.0;          // x of poses that only show that the channel reads

std::string vrpn_keys(const StandInVrpn& server, const std::string& more = "tracker = 'Arm'") {
  return fmt::format("[channels.hand]\nkind = 'vrpn'\nhost = '127.0.0.1'\nport = {}\n{}\n",
                     server.port(), more);
}

VrpnPose pose_of(int number, double time) {
  VrpnPose pose{time};
  pose.values[0] = number;
  return pose;
}

/// Poses from before the session are left out, so that the test begins with one that is taken.
void greet(StandInVrpn& server, ChannelRun& run) {
  ASSERT_EQ(run.channel().wait_until_open(), "");
  for (int i = 0; run.rows(0).empty(); ++i) {
    server.send(pose_of(-1, kStart + 1e-6 * i));
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
}

/// Waits for so many samples beside the greetings. @returns them
std::vector<ChannelRow> poses(ChannelRun& run, std::size_t count) {
  std::vector<ChannelRow> found;
  for (std::size_t all = 0; found.size() < count; ++all) {
    found = run.rows(all);
    std::erase_if(found, [](const ChannelRow& row) { return row.values[0] == kGreeting; });
  }
  return found;
}

TEST(VrpnChannelTest, PosesOfItsSensorAreRecordedToTheLastBit) {
  StandInVrpn server;
  server.set_sensor(2);
  ChannelRun run(vrpn_keys(server, "tracker = 'Arm'\nsensor = 2"));
  ASSERT_EQ(run.channel().wait_until_open(), "");
  RandomStream random(5, "poses");
  std::vector<VrpnPose> sent;
  for (int i = 0; i < 300; ++i) {
    VrpnPose pose{kStart + 0.004 * i, {}, 2};
    for (double& value : pose.values) {
      value = 2.0 * random.uniform() - 1.0;
    }
    Eigen::Map<Eigen::Vector4d>(pose.values.data() + 3).normalize();
    sent.push_back(pose);
  }
  for (int i = 0; run.rows(0).empty(); ++i) {
    VrpnPose greeting = pose_of(0, kStart - 1.0 + 1e-6 * i);
    greeting.values[0] = kGreeting;
    greeting.sensor = 2;
    server.send(greeting);
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  for (const VrpnPose& pose : sent) {
    server.send({pose.time, {7.0}, 1});                       // another sensor
    server.send({pose.time, {8.0}, 2}, StandInVrpn::kOther);  // another tracker
    server.send({pose.time, {9.0}, 2}, StandInVrpn::kArm, StandInVrpn::kVelocities);
    server.send(pose);
  }
  const auto rows = poses(run, sent.size());
  ASSERT_EQ(rows.size(), sent.size());
  for (std::size_t i = 0; i < sent.size(); ++i) {
    for (std::size_t k = 0; k < 7; ++k) {
      EXPECT_EQ(rows[i].values[k], sent[i].values[k]) << i;
    }
    EXPECT_NEAR(rows[i].device_time, sent[i].time, 0.6e-6);
  }
  EXPECT_EQ(server.heard().size(), 24u);
  EXPECT_EQ(server.heard().substr(0, 14), "vrpn: ver. 07.");
  EXPECT_TRUE(run.of_kind(Incident::kMalformed).empty());
  EXPECT_EQ(run.options().plan.quantities.at(6).name, "qw");
}

TEST(VrpnChannelTest, PosesThatComeAgainOrTooLateAreLeftOut) {
  StandInVrpn server;
  ChannelRun run(vrpn_keys(server));
  greet(server, run);
  server.send(pose_of(1, kStart + 1.00));
  server.send(pose_of(1, kStart + 1.00));  // again
  server.send(pose_of(2, kStart + 1.02));
  server.send(pose_of(3, kStart + 1.01));  // too late
  server.send(pose_of(4, kStart + 1.02));  // another pose of the same time
  const auto rows = poses(run, 3);
  EXPECT_EQ(rows[1].values[0], 2.0);
  EXPECT_EQ(rows[2].values[0], 4.0);
  run.incidents(Incident::kRepeated, 2);
  EXPECT_EQ(run.amount(Incident::kRepeated), 2.0);
  EXPECT_TRUE(run.of_kind(Incident::kLost).empty());
}

TEST(VrpnChannelTest, MalformedMessagesArePassedOver) {
  StandInVrpn server;
  ChannelRun run(vrpn_keys(server));
  greet(server, run);
  const std::string body = StandInVrpn::body_of(pose_of(1, 0.0));
  const auto message = [](const std::string& of) {
    return StandInVrpn::message(kStart + 1.0, StandInVrpn::kArm, StandInVrpn::kPoses, of);
  };
  server.send_bytes(message(body.substr(0, 61)));  // too short, filled up to 64
  server.send_bytes(message(body + body));
  server.send_bytes(message(""));
  std::string late = message(body);
  late.replace(8, 4, StandInVrpn::word(1'000'000));  // more microseconds than a second has
  server.send_bytes(late);
  server.send_bytes(StandInVrpn::message(0.0, 9, -1, StandInVrpn::word(100) + "short"));
  for (const char byte : message(StandInVrpn::body_of(pose_of(2, 0.0)))) {
    server.send_bytes(std::string(1, byte));
  }
  EXPECT_EQ(poses(run, 1)[0].values[0], 2.0);
  EXPECT_EQ(run.incidents(Incident::kMalformed, 5).size(), 5u);
  EXPECT_TRUE(run.of_kind(Incident::kLost).empty());
}

/// Servers send zeros for a body that is out of view. Its position is no measurement, either.
TEST(VrpnChannelTest, APoseWhoseQuaternionIsNotOfLengthOneIsMalformed) {
  StandInVrpn server;
  ChannelRun run(vrpn_keys(server));
  greet(server, run);
  const auto send = [&](int number, double qw) {
    VrpnPose pose = pose_of(number, kStart + 0.01 * number);
    pose.values[6] = qw;
    server.send(pose);
  };
  send(1, 0.0);
  send(2, 2.0);
  send(3, 0.98);
  send(4, 0.999);
  send(5, -1.0);
  const auto rows = poses(run, 2);
  EXPECT_EQ(rows[0].values[0], 4.0);
  EXPECT_EQ(rows[1].values[0], 5.0);
  EXPECT_EQ(run.incidents(Incident::kMalformed, 3).size(), 3u);
}

TEST(VrpnChannelTest, NumbersThatAreNotFiniteAreNotMeasured) {
  StandInVrpn server;
  ChannelRun run(vrpn_keys(server));
  greet(server, run);
  VrpnPose pose = pose_of(1, kStart + 1.0);
  pose.values[1] = std::numeric_limits<double>::quiet_NaN();
  pose.values[2] = std::numeric_limits<double>::infinity();
  server.send(pose);
  const auto rows = poses(run, 1);
  EXPECT_TRUE(std::isnan(rows[0].values[1]));
  EXPECT_TRUE(std::isnan(rows[0].values[2]));
  EXPECT_EQ(rows[0].values[6], 1.0);
}

TEST(VrpnChannelTest, BytesThatAreNoMessageEndTheConnectionWhichIsMadeAnew) {
  for (const std::uint32_t size : {0u, 23u, 0x7FFFFFFFu}) {
    StandInVrpn server;
    ChannelRun run(vrpn_keys(server));
    greet(server, run);
    server.send_bytes(StandInVrpn::word(size) + std::string(60, 'x'));
    EXPECT_THAT(run.incidents(Incident::kLost, 1)[0].text, HasSubstr("is no message of VRPN"));
    EXPECT_EQ(run.of_kind(Incident::kMalformed).size(), 1u);
    const std::size_t before = run.rows(0).size();
    while (run.rows(0).size() == before) {
      server.send(pose_of(1, kStart + 2.0 + run.now()));
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    run.incidents(Incident::kBack, 1);
  }
}

TEST(VrpnChannelTest, AServerThatDiesComesBack) {
  StandInVrpn server;
  ChannelRun run(vrpn_keys(server));
  greet(server, run);
  const std::size_t before = run.rows(0).size();
  server.set_listening(false);
  EXPECT_THAT(run.incidents(Incident::kLost, 1)[0].text, HasSubstr("closed the connection"));
  EXPECT_FALSE(run.channel().seen().live);
  server.set_listening(true);
  for (int i = 0; run.rows(0).size() < before + 3; ++i) {
    server.send(pose_of(i, kStart + 5.0 + i));
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  run.incidents(Incident::kBack, 1);
  const auto& rows = run.rows(0);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_EQ(rows[i].sample, i);
  }
}

TEST(VrpnChannelTest, AServerThatIsSilentIsLost) {
  StandInVrpn server;
  ChannelRun run(vrpn_keys(server));
  greet(server, run);
  EXPECT_THAT(run.incidents(Incident::kLost, 1)[0].text, HasSubstr("sends nothing more"));
}

TEST(VrpnChannelTest, ASensorThatIsHiddenIsLostWhileItsServerGoesOn) {
  StandInVrpn server;
  ChannelRun run(vrpn_keys(server));
  greet(server, run);
  run.set_now(2.0);  // longer than its patience
  server.send(pose_of(1, kStart), StandInVrpn::kOther);
  EXPECT_EQ(run.incidents(Incident::kLost, 1)[0].text, "no data come any more");
  server.send(pose_of(1, kStart + 2.0));
  run.incidents(Incident::kBack, 1);
}

TEST(VrpnChannelTest, PlantedTimesAreWithinTheStatedUncertainty) {
  StandInVrpn server;
  ChannelRun run(vrpn_keys(server, "tracker = 'Arm'\nlatency = 0.004\nrate = 240.0"));
  greet(server, run);
  RandomStream random(11, "way");
  constexpr int kPoses = 5000;  // 20 s
  std::vector<double> truths;
  double came_before = 0.0;
  for (int i = 1; i <= kPoses; ++i) {
    const double truth = i / 240.0;
    // The server's clock is 100 millionths slow, and its times are whole microseconds.
    const double stamp = kStart + 0.004 + truth * (1.0 - 100e-6);
    const double came = truth + 0.004 - 0.4e-3 * std::log(1.0 - random.uniform());
    came_before = std::max(came, came_before);
    run.set_now(came_before);
    server.send(pose_of(i, stamp));
    poses(run, static_cast<std::size_t>(i));
    truths.push_back(truth);
  }
  const auto rows = poses(run, kPoses);
  EXPECT_GT(test::share_within(rows, truths), 0.95);
  EXPECT_TRUE(run.of_kind(Incident::kClockStep).empty());
}

TEST(VrpnChannelTest, AClockThatStepsIsFollowedAnew) {
  StandInVrpn server;
  ChannelRun run(vrpn_keys(server));
  greet(server, run);
  const double steps[] = {0.0, 3600.0, 1800.0};  // ahead, then back by half
  int number = 0;
  for (const double step : steps) {
    for (int i = 0; i < 200; ++i) {
      ++number;
      run.set_now(0.01 * number);
      server.send(pose_of(number, kStart + 0.01 * number + step));
      poses(run, static_cast<std::size_t>(number));
    }
  }
  const auto stepped = run.of_kind(Incident::kClockStep);
  ASSERT_EQ(stepped.size(), 2u);
  EXPECT_NEAR(stepped[0].amount, 3600.0, 0.1);
  EXPECT_NEAR(stepped[1].amount, -1800.0, 0.6);
  EXPECT_TRUE(run.of_kind(Incident::kRepeated).empty());
}

TEST(VrpnChannelTest, AServerThatIsNoneGetsASentence) {
  const auto error = [](StandInVrpn& server, const std::string& keys = "tracker = 'Arm'") {
    return ChannelRun(vrpn_keys(server, keys)).channel().wait_until_open();
  };
  StandInVrpn other("HTTP/1.1 400 Bad Request\r\n");
  EXPECT_THAT(error(other), HasSubstr("is no VRPN server"));
  StandInVrpn old(std::string("vrpn: ver. 06.04  0\0\0\0\0\0", 24));
  EXPECT_THAT(error(old), HasSubstr("has version 06.04 of VRPN; only 07 is understood"));
  StandInVrpn mute("");
  EXPECT_THAT(error(mute), HasSubstr("does not answer"));
  StandInVrpn server;
  EXPECT_THAT(error(server, "tracker = 'Leg'"),
              HasSubstr("has no tracker 'Leg', but 'VRPN Control', 'Other', 'Arm'"));
  EXPECT_THAT(error(server, "tracker = 'Arm'\nsensor = 4"),
              HasSubstr("sends no pose of sensor 4 of 'Arm', but of 0"));
  server.set_listening(false);
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  EXPECT_THAT(error(server), HasSubstr("cannot be reached"));
}

TEST(VrpnChannelTest, MistakesInADefinitionGetASentence) {
  const auto problem = [](const std::string& keys) {
    return test::message_of([&] { test::channels_of("[channels.hand]\nkind = 'vrpn'\n" + keys); });
  };
  EXPECT_THAT(problem("tracker = 'a'"), HasSubstr("channels.hand.host"));
  EXPECT_THAT(problem("host = 'a'"), HasSubstr("channels.hand.tracker"));
  EXPECT_THAT(problem("host = 'a'\ntracker = 'a'\nsensor = -1"), HasSubstr("sensor is -1"));
  EXPECT_THAT(problem("host = 'a'\ntracker = 'a'\nport = 0"), HasSubstr("port is 0"));
  EXPECT_EQ(
      test::channels_of("[channels.hand]\nkind = 'vrpn'\nhost = 'a'\ntracker = 'a'\nrate = 0.5\n")
          .at(0)
          .plan.patience,
      6.0);
}

}  // namespace
}  // namespace haptrial::channel
