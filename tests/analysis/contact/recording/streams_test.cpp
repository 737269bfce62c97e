#include "analysis/contact/recording/streams.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "analysis/contact/recording/read_recording.h"
#include "analysis/files/csv.h"
#include "tests/support/message_of.h"

namespace haptrial::evaluation {
namespace {

using testing::HasSubstr;

ForceStream line_force(double rate, double seconds) {
  ForceStream force;
  for (const double t : even_times(0.0, seconds, 1.0 / rate)) {
    force.time.push_back(t);
    force.force.emplace_back(1.0 + 2.0 * t, -t, 4.0);
  }
  return force;
}

TEST(StreamsTest, AStraightLineIsItsOwnMean) {
  const ForceStream force = line_force(37.0, 3.0);
  const std::vector<double> times = even_times(0.5, 2.4, 0.013);
  for (const double width : {0.0, 0.01, 0.4}) {
    const ForceStream at = resampled(force, times, width);
    for (std::size_t i = 0; i < times.size(); ++i) {
      EXPECT_NEAR(at.force[i].x(), 1.0 + 2.0 * times[i], 1e-12) << width;
      EXPECT_NEAR(at.force[i].y(), -times[i], 1e-12) << width;
    }
  }
}

TEST(StreamsTest, TheMeanRemovesWhatTheNewRateCannotShow) {
  ForceStream force;
  for (const double t : even_times(0.0, 2.0, 1.0 / 5000.0)) {
    force.time.push_back(t);
    force.force.emplace_back(std::sin(2.0 * std::numbers::pi * 300.0 * t), 0.0, 0.0);
  }
  // Five whole periods of 300 Hz are in 1 / 60 s. What is left is of the chords that the window's
  // ends cut: (2π 300 h)² / 12 of a sample h = 1 / 5000 s at each.
  const ForceStream at = resampled(force, even_times(0.1, 1.9, 1.0 / 60.0), 1.0 / 60.0);
  for (const auto& f : at.force) {
    EXPECT_LT(std::abs(f.x()), 2.9e-4);
  }
}

TEST(StreamsTest, AConstantTurnIsKept) {
  PoseStream pose;
  const auto turned = [](double t) {
    return Eigen::Quaterniond(Eigen::AngleAxisd(1.3 * t, Eigen::Vector3d(1, 2, -1).normalized()));
  };
  for (const double t : even_times(0.0, 2.0, 0.25)) {
    pose.time.push_back(t);
    pose.position.emplace_back(t, 0.0, -t);
    pose.orientation.push_back(turned(t));
  }
  const std::vector<double> times = even_times(0.0, 2.0, 0.03);
  const PoseStream at = resampled(pose, times);
  for (std::size_t i = 0; i < times.size(); ++i) {
    EXPECT_LT(at.orientation[i].angularDistance(turned(times[i])), 1e-7);
    EXPECT_NEAR((at.position[i] - Eigen::Vector3d(times[i], 0.0, -times[i])).norm(), 0.0, 1e-14);
  }
}

TEST(StreamsTest, RepeatedSamplesAreLeftOut) {
  ForceStream force{{0.0, 0.1, 0.2, 0.3}, {}, {}};
  for (const double x : {1.0, 1.0, 2.0, 1.0}) {
    force.force.emplace_back(x, 0.0, 0.0);
  }
  EXPECT_EQ(changes(force).time, (std::vector{0.0, 0.2, 0.3}));
  force.torque.assign(4, Eigen::Vector3d::Zero());
  force.torque[1].y() = 1.0;
  EXPECT_EQ(changes(force).time, (std::vector{0.0, 0.1, 0.2, 0.3}));
}

/// A sensor in the air, in contact from 1 s to 2 s, and in the air again, `repeats` rows a reading.
ForceStream touch_between_airs(int repeats) {
  ForceStream force;
  for (int reading = 0; reading < 300; ++reading) {
    const bool air = reading < 100 || reading >= 200;
    for (int row = 0; row < repeats; ++row) {
      force.time.push_back(0.01 * (reading + static_cast<double>(row) / repeats));
      force.force.emplace_back(0.0, air ? 0.0 : 2.0 + std::sin(0.1 * reading), 0.0);
    }
  }
  return force;
}

TEST(StreamsTest, AValueThatIsHeldStaysUntilItChanges) {
  for (const int repeats : {1, 10}) {
    const ForceStream force = changes(touch_between_airs(repeats));
    EXPECT_NEAR(force.time.back(), 2.99, 0.01) << "the air at the end is recorded";
    const ForceStream at = resampled(force, std::vector{0.5, 0.98, 1.5, 2.5}, 0.0);
    EXPECT_EQ(at.force[0].y(), 0.0) << repeats;
    EXPECT_EQ(at.force[1].y(), 0.0) << repeats;
    EXPECT_NEAR(at.force[2].y(), 2.0 + std::sin(15.0), 1e-9) << repeats;
    EXPECT_EQ(at.force[3].y(), 0.0) << repeats;
  }
}

TEST(StreamsTest, AProbeThatRestsStaysWhereItIs) {
  PoseStream pose;
  for (const double t : even_times(0.0, 3.0, 0.01)) {
    pose.time.push_back(t);
    pose.position.emplace_back(std::max(0.0, t - 2.0), 0.0, 0.0);
    pose.orientation.push_back(Eigen::Quaterniond::Identity());
  }
  const PoseStream at = resampled(changes(pose), std::vector{1.0, 1.98, 2.5});
  EXPECT_EQ(at.position[0].x(), 0.0);
  EXPECT_EQ(at.position[1].x(), 0.0);
  EXPECT_NEAR(at.position[2].x(), 0.5, 1e-9);
}

TEST(StreamsTest, BadStreamsAreNamed) {
  ForceStream force = line_force(10.0, 1.0);
  force.time[3] = force.time[2];
  EXPECT_THAT(test::message_of<std::invalid_argument>([&] { check(force); }),
              HasSubstr("sample 3"));
  force = line_force(10.0, 1.0);
  force.force[4].z() = NAN;
  EXPECT_THAT(test::message_of<std::invalid_argument>([&] { check(force); }),
              HasSubstr("forces must be finite; sample 4"));
}

std::string reading_poses(const std::string& text) {
  return test::message_of([&] { read_poses(analysis::CsvTable::parse(text, "poses.csv")); });
}

TEST(ReadRecordingTest, UnitsOfTheColumnsCount) {
  const auto table = analysis::CsvTable::parse(
      "time_ms,x_mm,y_mm,z_mm,qw,qx,qy,qz,force_x_mN,force_y_mN,force_z_mN,torque_x_Nmm,"
      "torque_y_Nmm,torque_z_Nmm\n"
      "0,1,2,3,1,0,0,0,1000,0,0,5,0,0\n250,4,5,6,0,0,1,0,0,2000,0,0,7,0\n",
      "contact.csv");
  const PoseStream pose = read_poses(table);
  EXPECT_EQ(pose.time, (std::vector{0.0, 0.25}));
  EXPECT_NEAR((pose.position[1] - Eigen::Vector3d(0.004, 0.005, 0.006)).norm(), 0.0, 1e-15);
  EXPECT_NEAR(pose.orientation[1].y(), 1.0, 1e-15);
  const ForceStream force = read_forces(table);
  EXPECT_NEAR(force.force[0].x(), 1.0, 1e-15);
  EXPECT_NEAR(force.torque[1].y(), 0.007, 1e-15);
}

TEST(ReadRecordingTest, BadTablesGetASentence) {
  EXPECT_THAT(reading_poses("time,x_m,y_m,z_m\n0,1,2,3\n1,2,3,4\n"),
              HasSubstr("poses.csv: no column of 'time' with its unit; allowed: time_s, time_ms"));
  EXPECT_THAT(reading_poses("time_s,x_m,x_mm,y_m,z_m\n0,1,2,3,4\n1,2,3,4,5\n"),
              HasSubstr("'x_m' and 'x_mm' say the same"));
  EXPECT_THAT(reading_poses("time_s,x_m,y_m,z_m\n1,1,2,3\n0,2,3,4\n"),
              HasSubstr("poses.csv:3: time_s is '0'; allowed: times that do not go back"));
  EXPECT_THAT(reading_poses("time_s,x_m,y_m,z_m,qw,qx,qy,qz\n0,1,2,3,1,1,0,0\n1,1,2,3,1,0,0,0\n"),
              HasSubstr("poses.csv:2: qw is '1'; allowed: quaternions"));
  EXPECT_THAT(reading_poses("time_s,x_m,y_m,z_m\n0,1,2,3\n0,2,3,4\n"),
              HasSubstr("1 distinct times"));
  EXPECT_THAT(reading_poses("time_s,x_m,y_m,z_m\n0,one,2,3\n1,2,3,4\n"), HasSubstr("poses.csv:2"));
}

TEST(ReadRecordingTest, OfEqualTimesTheLastCounts) {
  const auto table =
      analysis::CsvTable::parse("time_s,x_m,y_m,z_m\n0,1,0,0\n0,2,0,0\n1,3,0,0\n", "poses.csv");
  const PoseStream pose = read_poses(table);
  ASSERT_EQ(pose.size(), 2u);
  EXPECT_EQ(pose.position[0].x(), 2.0);
}

}  // namespace
}  // namespace haptrial::evaluation
