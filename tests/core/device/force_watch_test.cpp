#include "core/device/force_watch.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>
#include <iterator>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "core/device/virtual_device.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/free_mass.h"
#include "tests/support/shared_data.h"

namespace haptrial::device::force_watch_test {
namespace {

using Eigen::Vector3d;
constexpr double kPi = std::numbers::pi;

/// Time at which a force of this course becomes a fault [s]; -1: never within `seconds`.
template <typename Course>
double found_after(double rate, Fault expected, double seconds, Course course,
                   const std::function<Vector3d(double)>& stimulus = nullptr) {
  ForceWatch watch(12.0, 3.0);
  const double dt = 1.0 / rate;
  for (int i = 0; i < static_cast<int>(seconds * rate); ++i) {
    const Fault fault =
        watch.look(course(i * dt), stimulus ? stimulus(i * dt) : Vector3d::Zero(), dt);
    if (fault != Fault::kNone) {
      EXPECT_EQ(fault, expected);
      return i * dt;
    }
  }
  return -1.0;
}

TEST(ForceWatchTest, AnOscillationNearTheLimitIsFoundWithin120Milliseconds) {
  for (const double rate : {1000.0, 2000.0, 4000.0}) {
    for (const double f : {22.0, 36.0, 45.0, 100.0, 0.1 * rate}) {
      for (const double offset : {0.0, 6.0}) {  // about zero, or off and on against a wall
        const double size = offset > 0.0 ? 5.5 : 11.0;
        const double at = found_after(rate, Fault::kOscillation, 1.0, [=](double t) {
          return Vector3d(0.3, offset + size * std::sin(2.0 * kPi * f * t), 0.0);
        });
        EXPECT_GE(at, 0.0) << f;
        EXPECT_LE(at, 0.120) << rate << " Hz: " << f << " Hz about " << offset;
      }
    }
  }
}

TEST(ForceWatchTest, WhatAHandAndAPatternDoIsNoOscillation) {
  for (const double f : {0.2, 1.0, 3.0, 5.0}) {  // a hand that shakes the handle with all force
    EXPECT_EQ(found_after(
                  1000.0, Fault::kNone, 10.0,
                  [=](double t) { return Vector3d(11.0 * std::sin(2.0 * kPi * f * t), 0.0, 0.0); }),
              -1.0)
        << f;
  }
  const auto vibration = [](double t) {
    return Vector3d(0.0, 1.5 * std::sin(2.0 * kPi * 40.0 * t), 0.0);
  };
  EXPECT_EQ(
      found_after(
          1000.0, Fault::kNone, 10.0,
          [&](double t) { return Vector3d(Vector3d(0.0, 6.0, 0.0) + vibration(t)); }, vibration),
      -1.0)
      << "a vibration of 3 N";
  EXPECT_EQ(found_after(
                1000.0, Fault::kNone, 10.0,
                [](double t) { return Vector3d(0.0, 3.0 + std::sin(2.0 * kPi * 12.0 * t), 0.0); }),
            -1.0)
      << "a tremor against a wall";
  EXPECT_EQ(found_after(
                1000.0, Fault::kNone, 10.0,
                [](double t) { return Vector3d(0.0, std::fmod(t, 0.5) < 0.02 ? 11.0 : 0.0, 0.0); }),
            -1.0)
      << "taps twice a second";
}

/// Far from the limit, too: whatever no stimulus accounts for.
TEST(ForceWatchTest, ASwingOf2NewtonFasterThanAHandIsFoundWithinAQuarterOfASecond) {
  for (const double rate : {500.0, 1000.0, 4000.0}) {
    for (const double f : {16.0, 30.0, 50.0, 150.0}) {
      const double at = found_after(rate, Fault::kOscillation, 2.0, [=](double t) {
        return Vector3d(1.5 + 1.1 * std::sin(2.0 * kPi * f * t), 0.0, 0.0);
      });
      EXPECT_GE(at, 0.2) << f;
      EXPECT_LE(at, 0.2 + 1.5 / f + 0.01) << rate << " Hz: " << f << " Hz";
    }
  }
}

TEST(ForceWatchTest, SaturationThatLastsIsFound) {
  const double at = found_after(1000.0, Fault::kSaturation, 10.0,
                                [](double) { return Vector3d(0.0, 12.0, 0.0); });
  EXPECT_NEAR(at, 3.0, 0.01);
  EXPECT_EQ(found_after(
                1000.0, Fault::kNone, 20.0,
                [](double t) { return Vector3d(0.0, std::fmod(t, 2.5) < 2.4 ? 12.0 : 11.0, 0.0); }),
            -1.0)
      << "it leaves the limit in between";
}

TEST(EnergyWatchTest, ASpringThatGivesBackWhatItTookIsNoFault) {
  EnergyWatch watch;
  double before = 0.0;
  for (int i = 1; i < 20'000; ++i) {
    const double x = 0.02 * std::sin(2.0 * kPi * 2.0 * 1e-3 * i);
    const Vector3d force(-900.0 * 0.5 * (x + before), 0.0, 0.0);
    ASSERT_FALSE(
        watch.look(force, Vector3d(x - before, 0.0, 0.0), {.stored = 450.0 * x * x}, 1e-3));
    before = x;
  }
  EXPECT_LT(watch.generated(), 0.01);
}

TEST(EnergyWatchTest, WhatIsMeantToWorkOnTheHandIsNoFault) {
  EnergyWatch watch;
  for (int i = 0; i < 2000; ++i) {  // pushed up with 10 N, led along with 5 N: 1 W
    const Vector3d force(5.0, 10.0, 0.0);
    const Vector3d moved(1e-4, 5e-5, 0.0);
    ASSERT_FALSE(
        watch.look(force, moved, {.drive = {0.1, 0.0, 0.0}, .push = {0.0, 10.0, 0.0}}, 1e-3));
  }
}

/// A wall with the wrong sign, a spring that grows, a damper that is negative.
TEST(EnergyWatchTest, AForceThatFeedsTheHandIsFoundWithin100Milliseconds) {
  for (const double k : {-2000.0, -500.0}) {
    test::FreeMass hand(0.5, {Vector3d(0.001, 0.0, 0.0), Vector3d::Zero()});
    EnergyWatch watch;
    double found = -1.0;
    for (int i = 0; i < 2000 && found < 0.0; ++i) {
      const Vector3d p = hand.state().position;
      Vector3d force = -k * p;
      force *= std::min(1.0, 12.0 / force.norm());
      hand.step(force, 1e-3);
      if (watch.look(force, hand.state().position - p, {}, 1e-3)) {
        found = 1e-3 * i;
      }
    }
    // 0.15 J are 12 N over 13 mm, or this spring let go over 24 mm: the hand moves that far.
    ASSERT_GE(found, 0.0);
    EXPECT_LE(hand.state().position.x(), 0.028) << k;
    EXPECT_LE(found, 0.150) << k;
  }
}

TEST(EnergyWatchTest, ALittleGeneratedAllTheTimeIsForgotten) {
  EnergyWatch watch;
  for (int i = 0; i < 100'000; ++i) {  // 0.1 W
    ASSERT_FALSE(watch.look(Vector3d(1.0, 0.0, 0.0), Vector3d(1e-4, 0.0, 0.0), {}, 1e-3));
  }
}

/// Rows of numbers in a file of data from outside; empty where it is absent.
std::vector<std::vector<double>> recorded(const std::string& name) {
  std::vector<std::vector<double>> rows;
  const auto file = test::shared_data(name);
  std::ifstream text(file ? file->string() : std::string());
  std::string row;
  std::getline(text, row);  // the header
  while (std::getline(text, row)) {
    std::ranges::replace(row, ',', ' ');
    std::istringstream cells(row);
    rows.emplace_back(std::istream_iterator<double>(cells), std::istream_iterator<double>());
  }
  return rows;
}

/// The force of a medium of 20 N·s/m and of a wall of 2000 N/m that a recorded hand would feel on
/// its way of half a metre. (The force that was recorded is of no use here: it has the vibration of
/// the arm that the hand led, 2 N at 20 Hz.)
TEST(ForceWatchTest, ARecordedHandDoesNotOscillate) {
  const auto rows = recorded("haptic/csrl_ur_admittance_human_500Hz.csv");
  if (rows.empty()) {
    GTEST_SKIP() << "neither HAPTRIAL_DATA nor ../shared/data holds "
                    "csrl_ur_admittance_human_500Hz.csv";
  }
  ForceWatch in_medium(12.0, 3.0);
  std::vector<ForceWatch> at_walls(3, ForceWatch(12.0, 30.0));
  constexpr std::size_t kWindow = 8;  // readings of a slope
  for (std::size_t i = kWindow; i < rows.size(); ++i) {
    const auto place = [&](std::size_t at) { return Vector3d(rows[at].data() + 1); };
    const Vector3d drag = -20.0 * (place(i) - place(i - kWindow)) / (kWindow * 2e-3);
    ASSERT_EQ(in_medium.look(drag, Vector3d::Zero(), 2e-3), Fault::kNone) << rows[i][0];
    for (int axis = 0; axis < 3; ++axis) {
      const double depth = place(i)[axis] - place(0)[axis];
      const Vector3d push = -std::clamp(2000.0 * depth, 0.0, 12.0) * Vector3d::Unit(axis);
      ASSERT_NE(at_walls[axis].look(push, Vector3d::Zero(), 2e-3), Fault::kOscillation)
          << rows[i][0];
    }
  }
}

TEST(ForceWatchTest, ATickDoesNotAllocate) {
  ForceWatch forces(12.0, 3.0);
  EnergyWatch energy;
  const test::AllocationGuard guard;
  for (int i = 0; i < 1000; ++i) {
    const Vector3d force(12.0 * std::sin(i), 0.0, 0.0);
    forces.look(force, Vector3d::Zero(), 1e-3);
    energy.look(force, Vector3d(1e-4, 0.0, 0.0), {}, 1e-3);
  }
  EXPECT_EQ(guard.count(), 0u);
}

}  // namespace
}  // namespace haptrial::device::force_watch_test
