#include "analysis/contact/recording/sensor_load.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "analysis/contact/recording/stream_lag.h"
#include "tests/analysis/contact/simulated_contact.h"

namespace haptrial::evaluation {
namespace {

using testing::HasSubstr;

test::SimulatedContact loaded() {
  test::SimulatedContact s;
  s.mount.orientation = Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, -1, 2).normalized());
  s.load.weight = {0.1, -1.96, 0.05};
  s.load.force_offset = {0.4, -0.2, 0.9};
  return s;
}

/// The same probe held in the air, turned all ways.
ContactRecording in_the_air(const test::SimulatedContact& s, double force_noise, double turn) {
  ContactRecording recording;
  RandomStream random(5, "air");
  for (const double t : even_times(0.0, 10.0, 0.01)) {
    recording.pose.time.push_back(t);
    recording.pose.position.push_back(Eigen::Vector3d::Zero());
    recording.pose.orientation.push_back(
        Eigen::Quaterniond::Identity().slerp(turn, test::hand_turn(t)));
    const Eigen::Matrix3d to_sensor =
        (recording.pose.orientation.back() * s.mount.orientation).toRotationMatrix().transpose();
    const Eigen::Vector3d w = to_sensor * s.load.weight;
    const Eigen::Vector3d noise(random.normal(), random.normal(), random.normal());
    recording.force.time.push_back(t);
    recording.force.force.emplace_back(w + s.load.force_offset + force_noise * noise);
    recording.force.torque.emplace_back(s.load.centre.cross(w) + s.load.torque_offset);
  }
  return recording;
}

TEST(SensorLoadTest, WeightCentreAndOffsetsAreFound) {
  test::SimulatedContact s = loaded();
  s.load.centre = {0.002, -0.001, 0.027};
  s.load.torque_offset = {0.01, 0.02, -0.03};
  const LoadFit fit = estimate_load(in_the_air(s, 0.0, 1.0), s.mount, {{0.0, 10.0}});
  EXPECT_THAT(fit.unfixed, testing::IsEmpty());
  EXPECT_NEAR((fit.load.weight - s.load.weight).norm(), 0.0, 1e-9);
  EXPECT_NEAR((fit.load.force_offset - s.load.force_offset).norm(), 0.0, 1e-9);
  EXPECT_NEAR((fit.load.centre - s.load.centre).norm(), 0.0, 1e-9);
  EXPECT_NEAR((fit.load.torque_offset - s.load.torque_offset).norm(), 0.0, 1e-9);
  const ForceStream rest = contact_forces(in_the_air(s, 0.0, 1.0), s.mount, fit.load);
  for (std::size_t i = 0; i < rest.size(); ++i) {
    EXPECT_LT(rest.force[i].norm(), 1e-9);
    EXPECT_LT(rest.torque[i].norm(), 1e-9);
  }
}

TEST(SensorLoadTest, OneOrientationLeavesWeightAndOffsetMixed) {
  const LoadFit fit = estimate_load(in_the_air(loaded(), 0.01, 0.0), loaded().mount, {{0.0, 10.0}});
  ASSERT_FALSE(fit.unfixed.empty());
  EXPECT_THAT(fit.unfixed.front(), HasSubstr("only a combination"));
  // A mixed reading still explains that orientation.
  EXPECT_NEAR(fit.force_rms, 0.01, 0.001);
}

TEST(SensorLoadTest, AContactKeepsItsForcesWithoutTheLoad) {
  const test::SimulatedContact s = loaded();
  const ContactRecording recording = test::simulate(s);
  const ForceStream force = contact_forces(recording, s.mount, s.load);
  double worst = 0.0;
  for (std::size_t i = 0; i < force.size(); ++i) {
    worst = std::max(worst, (force.force[i] - test::hand_force(force.time[i], s)).norm());
  }
  EXPECT_LT(worst, 2e-3);  // orientations between samples 1/60 s apart: 1/8 (1/60)² 0.7 rad/s² 3 N
}

/// Recordings of noisy streams with known lags: the interval should hold them.
TEST(StreamLagTest, KnownLagsAreFoundAndIntervalsHoldThem) {
  int held = 0;
  double worst = 0.0;
  constexpr int kRecordings = 20;
  for (int i = 0; i < kRecordings; ++i) {
    test::SimulatedContact s;
    s.seed = static_cast<std::uint64_t>(i);
    s.lag = -0.1 + 0.01 * i;
    s.pose_noise = 0.0001;
    s.force_noise = 0.05;
    s.force_rate = 500.0;
    const ContactRecording recording = test::simulate(s);
    const LagFit fit =
        estimate_lag(recording.pose, contact_forces(recording, s.mount, s.load), {0.2, 0.004, 0.5});
    EXPECT_EQ(fit.doubt, "") << s.lag;
    worst = std::max(worst, std::abs(fit.lag - s.lag));
    held += fit.low <= s.lag && s.lag <= fit.high ? 1 : 0;
  }
  RecordProperty("held", held);
  RecordProperty("worst_us", static_cast<int>(1e6 * worst));
  EXPECT_LT(worst, 0.5 / 60.0);  // half a period of the slower stream
  EXPECT_GE(held, 15);           // fewer than 15 of 20 at 95 %: once in 3,000 times
}

TEST(StreamLagTest, UnrelatedStreamsAreDoubted) {
  test::SimulatedContact s;
  ContactRecording recording = test::simulate(s);
  RandomStream random(9, "unrelated");
  for (auto& f : recording.force.force) {
    f = Eigen::Vector3d(random.normal(), random.normal(), random.normal());
  }
  EXPECT_THAT(estimate_lag(recording.pose, recording.force).doubt, HasSubstr("not to be trusted"));
}

TEST(StreamLagTest, ALagBeyondTheRangeIsDoubted) {
  test::SimulatedContact s;
  s.lag = 0.15;
  const ContactRecording recording = test::simulate(s);
  EXPECT_NE(
      estimate_lag(recording.pose, contact_forces(recording, s.mount, s.load), {0.1, 0.004, 0.5})
          .doubt,
      "");
}

}  // namespace
}  // namespace haptrial::evaluation
