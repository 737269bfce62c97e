// Promises of every device, over all of them: the simulated ones, and the vendors' drivers on
// stand-in libraries.

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "core/device/envelope.h"
#include "tests/core/device/device_rigs.h"
#include "tests/support/allocation_guard.h"

namespace haptrial::device {
namespace {

using Eigen::Vector3d;
constexpr double kDt = 1.0 / test::kRigRate;

class DeviceSuiteTest : public ::testing::TestWithParam<test::RigKind> {
 protected:
  DeviceReading tick(const Vector3d& force) {
    DeviceReading reading;
    EXPECT_TRUE(rig_->device().read(reading)) << rig_->device().trouble();
    EXPECT_TRUE(rig_->device().write(force)) << rig_->device().trouble();
    rig_->period();
    return reading;
  }
  DeviceReading hold(const Vector3d& force, int ticks) {
    DeviceReading reading;
    for (int i = 0; i < ticks; ++i) {
      reading = tick(force);
    }
    return reading;
  }
  std::unique_ptr<test::Rig> rig_{GetParam().make()};
};

INSTANTIATE_TEST_SUITE_P(Devices, DeviceSuiteTest, ::testing::ValuesIn(test::every_rig()),
                         [](const auto& kind) { return kind.param.name; });

TEST_P(DeviceSuiteTest, SaysWhatItCanDo) {
  const DeviceInfo& info = rig_->device().info();
  EXPECT_FALSE(info.name.empty());
  EXPECT_GT(info.max_force, 0.5);
  EXPECT_LT(info.max_force, 50.0);
  EXPECT_GT(info.workspace_radius, 0.01);
  EXPECT_LT(info.workspace_radius, 0.5);
  EXPECT_STREQ(rig_->device().trouble(), "");
}

TEST_P(DeviceSuiteTest, ReadsFiniteValuesWithItsForcesOn) {
  for (int i = 0; i < 100; ++i) {
    const DeviceReading reading = tick(Vector3d::Zero());
    ASSERT_TRUE(reading.tool.position.allFinite());
    ASSERT_TRUE(reading.tool.velocity.allFinite());
    ASSERT_TRUE(reading.forces_on);
    ASSERT_LE(reading.tool.position.norm(), rig_->device().info().workspace_radius);
  }
}

TEST_P(DeviceSuiteTest, AForceMovesTheToolAlongItsOwnAxisByItsOwnMeasure) {
  rig_->place(Vector3d::Zero());  // a recording does not yield: its compliance is 0
  for (int axis = 0; axis < 3; ++axis) {
    for (const double force : {1.0, -2.0}) {
      hold(Vector3d::Zero(), 1000);
      const Vector3d before = tick(Vector3d::Zero()).tool.position;
      const DeviceReading early = hold(force * Vector3d::Unit(axis), 30);
      const double compliance = rig_->compliance() * rig_->device().info().force_axes[axis];
      EXPECT_EQ(early.tool.velocity[axis] * force > 0.0, compliance > 0.0) << axis;
      const Vector3d moved = hold(force * Vector3d::Unit(axis), 1500).tool.position - before;
      EXPECT_LT((moved - force * compliance * Vector3d::Unit(axis)).norm(), 2e-6)
          << "axis " << axis << ": " << moved.transpose();
    }
  }
}

TEST_P(DeviceSuiteTest, EveryAxisAndUnitIsThatOfTheWorld) {
  const Vector3d where{0.01, -0.02, 0.03};
  rig_->place(where);
  const Vector3d expected = where.cwiseProduct(rig_->device().info().force_axes);
  EXPECT_LT((hold(Vector3d::Zero(), 2000).tool.position - expected).norm(), 2e-7);
}

TEST_P(DeviceSuiteTest, VelocityIsTheRateOfPosition) {
  // The electronics of the simulated devices look back over 8 readings: compare around the middle.
  std::vector<PointState> hand;
  for (int i = 0; i < 2000; ++i) {
    hand.push_back(tick(2.0 * std::sin(0.01 * i) * Vector3d(1.0, 0.5, -1.0)).tool);
  }
  double error = 0.0;
  double speed = 0.0;
  for (std::size_t i = 500; i + 8 < hand.size(); ++i) {
    const Vector3d slope = (hand[i].position - hand[i - 7].position) / (7.0 * kDt);
    error += (hand[i].velocity - slope).squaredNorm();
    speed += slope.squaredNorm();
  }
  EXPECT_GT(speed, 0.0);
  EXPECT_LT(std::sqrt(error / speed), 0.05);
}

TEST_P(DeviceSuiteTest, TellsItsButtons) {
  EXPECT_EQ(tick(Vector3d::Zero()).buttons, 0u);
  const std::uint32_t expected = rig_->press_button() ? 1 : 0;  // some have none
  tick(Vector3d::Zero());
  EXPECT_EQ(tick(Vector3d::Zero()).buttons, expected);
}

TEST_P(DeviceSuiteTest, ATickDoesNotAllocate) {
  tick(Vector3d::Zero());
  DeviceReading reading;
  std::size_t allocations = 0;
  for (int i = 0; i < 1000; ++i) {
    const test::AllocationGuard guard;
    rig_->device().read(reading);
    rig_->device().write(Eigen::Vector3d(0.1, 0.0, 0.0));
    const std::size_t before = guard.count();
    rig_->period();
    allocations += rig_->period_is_the_drivers() ? guard.count() : before;
  }
  EXPECT_EQ(allocations, 0u);
}

TEST_P(DeviceSuiteTest, ClosingLeavesNoForce) {
  hold({0.0, 1.0, 0.0}, 50);
  EXPECT_EQ(rig_->force_after_close(), 0.0);
}

TEST_P(DeviceSuiteTest, CanBeOpenedAgain) {
  hold({0.0, 1.0, 0.0}, 50);
  rig_.reset();
  rig_ = GetParam().make();
  EXPECT_TRUE(tick(Vector3d::Zero()).tool.position.allFinite());
}

/// A whole sentence's worth: letters, blanks, no end of line.
bool is_sentence(const std::string& text) {
  return text.size() > 15 && text.find(' ') != std::string::npos &&
         text.find('\n') == std::string::npos;
}

TEST_P(DeviceSuiteTest, EveryFailureBringsTheForceToZeroInTheSameTickAndHasAReason) {
  constexpr long kTick = 200;
  for (const test::RigFailure& failure : rig_->failures()) {
    SCOPED_TRACE(failure.name);
    rig_.reset();
    rig_ = GetParam().make();
    rig_->fail(failure.failure, kTick);
    EnvelopeLimits limits;
    limits.max_force = 3.3;
    Envelope envelope(limits);
    DeviceReading reading;
    long faulted = -1;
    std::string trouble;
    for (long tick = 0; tick < kTick + 60; ++tick) {
      envelope.check(rig_->device().read(reading), reading);
      trouble =
          envelope.fault() != Fault::kNone && faulted < 0 ? rig_->device().trouble() : trouble;
      const Vector3d force = envelope.limit({1.0, 0.5, 0.0}, kDt);
      ASSERT_TRUE(envelope.fault() == Fault::kNone || force.isZero(0.0)) << tick;
      if (tick == kTick - 1) {
        EXPECT_EQ(envelope.fault(), Fault::kNone) << describe(envelope.fault());
        EXPECT_GT(force.norm(), 0.5) << "there was a force to lose";
      }
      if (!rig_->device().write(force) && envelope.fault() == Fault::kNone) {
        envelope.trip(Fault::kWriteFailed);
        trouble = rig_->device().trouble();
      }
      rig_->period();
      if (envelope.fault() != Fault::kNone && faulted < 0) {
        faulted = tick;
      }
    }
    if (failure.harmless) {
      EXPECT_EQ(envelope.fault(), Fault::kNone) << describe(envelope.fault());
      continue;
    }
    ASSERT_GE(faulted, 0) << "nobody noticed";
    EXPECT_LE(std::abs(faulted - kTick), failure.delay + 1);
    EXPECT_TRUE(is_sentence(describe(envelope.fault())));
    const bool of_device = envelope.fault() == Fault::kReadFailed ||
                           envelope.fault() == Fault::kWriteFailed ||
                           envelope.fault() == Fault::kForcesOff;
    EXPECT_TRUE(!of_device || is_sentence(trouble)) << trouble;
  }
}

}  // namespace
}  // namespace haptrial::device
