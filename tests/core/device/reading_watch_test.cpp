#include "core/device/reading_watch.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <fstream>
#include <sstream>
#include <string>

#include "core/base/random.h"
#include "core/device/handle_physics.h"
#include "core/device/virtual_device.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/shared_data.h"

namespace haptrial::device {
namespace {

using Eigen::Vector3d;

/// Time at which a fault is found [s]; -1: never.
template <typename Position, typename Force>
double found_after(double rate, Fault expected, Position position, Force force) {
  ReadingWatch watch(0.5);
  const double dt = 1.0 / rate;
  for (int i = 0; i < static_cast<int>(2.0 * rate); ++i) {
    const Fault fault = watch.look(position(i * dt), Vector3d::Zero(), force(i * dt), dt);
    if (fault != Fault::kNone) {
      EXPECT_EQ(fault, expected);
      return i * dt;
    }
  }
  return -1.0;
}

constexpr double kBegin = 0.5;  // [s]

TEST(ReadingWatchTest, AReadingThatStaysWhileItsVelocityDoesIsFoundWithin50Milliseconds) {
  ReadingWatch watch(0.5);
  int ticks = 0;
  while (watch.look({0.01, 0.0, 0.0}, {0.016, 0.0, 0.0}, Vector3d::Zero(), 1e-3) == Fault::kNone) {
    ASSERT_LT(++ticks, 50);
  }
  EXPECT_GE(ticks, 20);
}

/// 900 N/m that are stretched at 16 mm/s are the slowest: there it is in doubt after 60 ms, when
/// the force has grown by 1 N. From then on the force falls, as the envelope lets it.
TEST(ReadingWatchTest, AFrozenReadingIsInDoubtWithin50MillisecondsAndAFaultWhenTheForceHasFallen) {
  for (const double rate : {1000.0, 2000.0, 4000.0}) {
    for (const double slope : {14.4, 25.0, 100.0, 1000.0}) {  // of the force [N/s]
      SCOPED_TRACE(testing::Message() << rate << " Hz, " << slope << " N/s");
      ReadingWatch watch(0.5);
      Vector3d force(0.0, 1.0, 0.0);
      double doubted = -1.0;
      double found = -1.0;
      for (int i = 0; i < static_cast<int>(2.0 * rate) && found < 0.0; ++i) {
        const double t = i / rate;
        const double x = 1e-6 * std::round(1e6 * 0.016 * std::min(t, kBegin));
        if (watch.in_doubt()) {
          force *= std::max(0.0, 1.0 - 20.0 / rate / force.norm());
        } else {
          force.x() = std::max(0.0, slope * (t - kBegin));
        }
        found = watch.look({x, 0.0, 0.0}, Vector3d::Zero(), force, 1.0 / rate) == Fault::kFrozen
                    ? t
                    : -1.0;
        doubted = doubted < 0.0 && watch.in_doubt() ? t : doubted;
      }
      EXPECT_GT(doubted, kBegin);
      EXPECT_LE(doubted, kBegin + (slope < 20.0 ? 0.060 : 0.050));
      EXPECT_GT(found, doubted);
      const double gone = slope < 30.0 ? 0.25 : 0.0;  // there is less than 1.5 N to lose
      EXPECT_LE(found, doubted + gone + 1.6 / 20.0 + 2.0 / rate) << "1.5 N fall at 20 N/s";
    }
  }
}

/// A hand that comes to rest where nothing pushes it, as in a detent.
TEST(ReadingWatchTest, AHandThatStopsWhereTheForceIsGoneIsNoDoubt) {
  ReadingWatch watch(0.5);
  for (int i = 0; i < 2000; ++i) {
    const double x = std::max(0.0, 1e-4 - 1e-6 * i);
    watch.look({x, 0.0, 0.0}, Vector3d::Zero(), {-2e4 * x, 0.0, 0.0}, 1e-3);
    ASSERT_FALSE(watch.in_doubt()) << i;
  }
}

/// The change is 3 N and alternates: no handle moves by more than its encoder resolves.
TEST(ReadingWatchTest, AVibrationThatMovesNothingIsNoDoubt) {
  for (const double hertz : {100.0, 201.0, 250.0, 333.0}) {  // of 333 Hz no sample may be near 0
    for (const double phase : {0.0, 0.5, 1.0, 1.5}) {
      ReadingWatch watch(0.5);
      for (int i = 0; i < 3000; ++i) {
        const double angle = 2.0 * 3.14159 * hertz * 1e-3 * i + phase;
        const double y = i % 700 != 699 ? 0.0 : 1e-5;  // a step of the encoder
        watch.look({0.01, y, 0.0}, Vector3d::Zero(),
                   {0.0, i < 100 ? 0.0 : 3.0 * std::sin(angle), 0.0}, 1e-3);
        ASSERT_FALSE(watch.in_doubt()) << hertz << " Hz, " << phase << " at " << i << " ms";
      }
    }
  }
}

TEST(ReadingWatchTest, AHandThatHoldsStillUnderASteadyForceIsNoFault) {
  EXPECT_EQ(found_after(
                1000.0, Fault::kNone, [](double) { return Vector3d(0.01, 0.0, 0.0); },
                [](double t) { return Vector3d(5.0 + 0.2 * std::sin(50.0 * t), 0.0, 0.0); }),
            -1.0);
}

TEST(ReadingWatchTest, JitterIsFoundWithin50Milliseconds) {
  for (const double rate : {1000.0, 2000.0, 4000.0}) {
    for (const double size : {0.004, 0.0005, 0.0003}) {  // to each side [m]
      for (const int every : {1, 2, 5}) {                // ticks
        const double at = found_after(
            rate, Fault::kJitter,
            [=](double t) {
              const int tick = static_cast<int>(std::lround(t * rate));
              const bool off = t >= kBegin && (tick / every) % 2 == 1;
              return Vector3d(off ? size : -size, 1e-7 * tick, 0.0);
            },
            [](double) { return Vector3d(1.0, 0.0, 0.0); });
        EXPECT_GE(at, kBegin);
        EXPECT_LE(at, kBegin + 0.050) << rate << " Hz, " << size << " m, every " << every;
      }
    }
  }
}

TEST(ReadingWatchTest, KnocksAndFastStrokesAreNoFault) {
  // A knock against a stop twice a second, strokes of 5 cm at 3 Hz, noise of the encoders.
  for (const double rate : {1000.0, 4000.0}) {
    RandomStream random(1, "noise");
    EXPECT_EQ(found_after(
                  rate, Fault::kNone,
                  [&](double t) {
                    const double triangle = std::abs(std::fmod(2.0 * t, 1.0) - 0.5);
                    const Vector3d p(0.05 * std::sin(6.0 * 3.14159 * t), 0.4 * triangle,
                                     random.uniform(-1e-5, 1e-5));
                    return Vector3d(1e-5 * (1e5 * p).array().round().matrix());
                  },
                  [](double t) { return Vector3d(3.0 * std::sin(10.0 * t), 0.0, 0.0); }),
              -1.0)
        << rate;
  }
}

/// The device's clock and the loop's: a reading is given twice, the next one is left out.
TEST(ReadingWatchTest, AStrokeReadByAnotherClockIsNoFault) {
  for (const double rate : {1000.0, 4000.0}) {
    RandomStream random(2, "lateness");
    double newest = 0.0;  // that the device has measured [s]
    EXPECT_EQ(found_after(
                  rate, Fault::kNone,
                  [&](double t) {
                    const double late = random.uniform(-1.0, 1.0) / rate;
                    newest = std::max(newest, std::floor((t + late) * rate) / rate);
                    return Vector3d(0.1 * std::sin(12.0 * newest), 1e-7 * t, 0.0);
                  },
                  [](double) { return Vector3d(1.0, 0.0, 0.0); }),
              -1.0)
        << rate;
  }
}

/// Coulomb friction below the holding force, coarse encoders, and a force that wanders slowly.
TEST(ReadingWatchTest, AHandOnAVirtualDeviceThatHoldsStillIsNoFault) {
  for (const double quantum : {1e-6, 1e-5, 6e-5}) {
    for (const double stiffness : {250.0, 2000.0}) {  // of the hand [N/m]
      CoupledMass hand({1.0, stiffness, 40.0});
      VirtualDeviceParameters parameters;
      parameters.position_quantum = quantum;
      VirtualDevice device(parameters, hand, 1000.0);
      ReadingWatch watch(0.5);
      for (int i = 0; i < 20'000; ++i) {
        DeviceReading reading;
        device.read(reading);
        const double t = 1e-3 * i;
        const Vector3d force(2.0 * std::sin(t), 5.0 * std::sin(0.3 * t), std::fmod(t, 2.0));
        ASSERT_EQ(watch.look(reading.tool.position, reading.tool.velocity, force, 1e-3),
                  Fault::kNone)
            << quantum << " " << stiffness << " at " << t;
        device.write(force);
      }
    }
  }
}

/// Hands that lead an arm (500 Hz) and a tool along a body (pose at 30 Hz, in rows at events).
TEST(ReadingWatchTest, RecordedHandsDoNotJitter) {
  const auto file = test::shared_data("haptic/csrl_ur_admittance_human_500Hz.csv");
  if (!file) {
    GTEST_SKIP()
        << "neither HAPTRIAL_DATA nor ../shared/data holds csrl_ur_admittance_human_500Hz.csv";
  }
  std::ifstream rows(*file);
  std::string row;
  std::getline(rows, row);
  ReadingWatch watch(0.5);
  int read = 0;
  while (std::getline(rows, row)) {
    std::istringstream cells(row);
    std::array<double, 4> cell{};  // time and position
    for (double& number : cell) {
      cells >> number;
      cells.ignore();
    }
    // The device holds still below 4 N by its own law, so the force is left out.
    ASSERT_EQ(watch.look({cell[1], cell[2], cell[3]}, Vector3d::Zero(), Vector3d::Zero(), 2e-3),
              Fault::kNone)
        << row;
    ++read;
  }
  EXPECT_GT(read, 5000);
}

TEST(ReadingWatchTest, ItIsSuspiciousBeforeItIsSureAndCalmAgainAfterwards) {
  ReadingWatch watch(0.5);
  const Vector3d force(1.0, 0.0, 0.0);
  double x = 0.0;
  const auto moves = [&] {
    return watch.look(Vector3d(x += 1e-5, 0.0, 0.0), Vector3d::Zero(), force, 1e-3);
  };
  for (int i = 0; i < 100; ++i) {
    moves();
    ASSERT_FALSE(watch.suspicious());
  }
  for (int i = 0; i < 12; ++i) {
    watch.look(Vector3d(x, 0.0, 0.0), Vector3d::Zero(), force, 1e-3);
  }
  EXPECT_TRUE(watch.suspicious()) << "equal for more than 10 ms";
  moves();
  EXPECT_FALSE(watch.suspicious());
  watch.look(Vector3d(x += 0.004, 0.0, 0.0), Vector3d::Zero(), force, 1e-3);
  EXPECT_TRUE(watch.suspicious()) << "an odd step";
  for (int i = 0; i < 60; ++i) {
    EXPECT_EQ(moves(), Fault::kNone);
  }
  EXPECT_FALSE(watch.suspicious());
}

TEST(ReadingWatchTest, ATickDoesNotAllocate) {
  ReadingWatch watch(0.5);
  const test::AllocationGuard guard;
  for (int i = 0; i < 1000; ++i) {
    watch.look(Vector3d(1e-3 * (i % 3), 0.0, 0.0), Vector3d::Zero(), Vector3d(i, 0.0, 0.0), 1e-3);
  }
  EXPECT_EQ(guard.count(), 0u);
}

}  // namespace
}  // namespace haptrial::device
