// The coupled mass, the mouse and the replay device against exact cases.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <thread>

#include "core/base/definition/schema.h"
#include "core/device/handle_physics.h"
#include "core/device/mouse.h"
#include "core/device/replay.h"

namespace haptrial::device::simulated_devices_test {
namespace {

using Eigen::Vector3d;
constexpr double kRate = 1000.0;
constexpr double kDt = 1.0 / kRate;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TEST(CoupledMassTest, SwingsAsTheSpringEquationSays) {
  // x'' = -k/m x from rest at a distance of 10 mm: x = 10 mm cos(w t), w = 20 rad/s.
  CoupledMass mass({1.0, 400.0, 0.0}, {0.01, 0.0, 0.0});
  mass.set_anchor(Vector3d::Zero());
  constexpr double kStep = 1e-5;
  for (int i = 1; i <= 100000; ++i) {
    const double x = mass.step(Vector3d::Zero(), kStep).position.x();
    if (i % 1000 == 0) {
      ASSERT_NEAR(x, 0.01 * std::cos(20.0 * i * kStep), 2e-6) << i;
    }
  }
}

TEST(CoupledMassTest, RestsWhereTheForcesBalance) {
  CoupledMass mass({1.0, 400.0, 40.0});
  mass.set_anchor({0.01, 0.0, 0.0});
  mass.set_press_force({0.0, -8.0, 0.0});
  for (int i = 0; i < 3000; ++i) {
    mass.step({0.0, 0.0, 2.0}, kDt);
  }
  EXPECT_LT((mass.state().position - Vector3d(0.01, -0.02, 0.005)).norm(), 1e-9);
  EXPECT_LT(mass.state().velocity.norm(), 1e-9);
}

TEST(CoupledMassTest, ParametersOutOfBoundsAreRefused) {
  EXPECT_THROW(CoupledMass({0.0, 1.0, 1.0}), std::invalid_argument);
  EXPECT_THROW(CoupledMass({1.0, -1.0, 1.0}), std::invalid_argument);
  EXPECT_THROW(CoupledMass({1.0, 1.0, kNan}), std::invalid_argument);
}

DeviceReading after(MouseDevice& mouse, int ticks, const Vector3d& force = Vector3d::Zero()) {
  DeviceReading reading;
  for (int i = 0; i < ticks; ++i) {
    EXPECT_TRUE(mouse.read(reading));
    EXPECT_TRUE(mouse.write(force));
  }
  return reading;
}

TEST(MouseTest, TheToolGoesWhereThePointerPoints) {
  MouseDevice mouse({}, kRate);
  mouse.move(0.03, -0.02);
  EXPECT_LT((after(mouse, 3000).tool.position - Vector3d(0.03, 0.0, -0.02)).norm(), 1e-5);
}

TEST(MouseTest, APointerAcrossTheScreenStaysWithinTheDefaultEnvelopesSpeedAndJump) {
  MouseDevice mouse({}, kRate);
  DeviceReading reading;
  Vector3d before = Vector3d::Zero();
  double fastest = 0.0;
  for (int i = 0; i < 4000; ++i) {
    mouse.move(i / 500 % 2 == 0 ? 1.0 : -1.0, 0.0);  // far out, from side to side
    mouse.read(reading);
    mouse.write(Vector3d::Zero());
    ASSERT_LT((reading.tool.position - before).norm(), 0.005);
    ASSERT_LE(reading.tool.position.norm(), 0.075);
    before = reading.tool.position;
    fastest = std::max(fastest, reading.tool.velocity.norm());
  }
  EXPECT_LT(fastest, 1.0);
  EXPECT_GT(fastest, 0.3) << "it did go there and back";
}

TEST(MouseTest, APressIsHeldByTheDeviceThatHoldsAgainstIt) {
  MouseDevice mouse({}, kRate);
  mouse.press(6.0);
  DeviceReading reading;
  double held = 0.0;
  for (int i = 0; i < 4000; ++i) {  // a plane constraint, as in visual training
    mouse.read(reading);
    held = -2000.0 * reading.tool.position.y() - 40.0 * reading.tool.velocity.y();
    mouse.write(Eigen::Vector3d(0.0, held, 0.0));
  }
  EXPECT_NEAR(held, 6.0 * 2000.0 / 2400.0, 0.05) << "the hand's own spring takes its share";
  mouse.press(0.0);
  EXPECT_LT(std::abs(after(mouse, 3000).tool.position.y()), 1e-5);
}

TEST(MouseTest, TheWheelSetsThePressOfTheLeftButton) {
  Table table = Table::parse(
      "pointer_speed = 0.3\nmax_press = 8.0\nfirst_press = 1.5\npress_step = 0.25\n"
      "stop_button = 2\n",
      "m.toml");
  const MouseParameters p = mouse_schema().read(table);
  EXPECT_NO_THROW(table.finish());
  EXPECT_EQ(p.pointer_speed, 0.3);
  EXPECT_EQ(p.max_press, 8.0);
  MouseDevice mouse(p, kRate);
  const auto pressed_at = [&](double wheel) {  // [m]
    mouse.turn_wheel(wheel, true);
    return -after(mouse, 3000).tool.position.y();
  };
  const double first = pressed_at(0.0);
  EXPECT_GT(first, 0.0);
  EXPECT_NEAR(pressed_at(4.0) / first, 2.5 / 1.5, 1e-3);
  EXPECT_NEAR(pressed_at(-40.0), 0.0, 1e-5) << "never upward";
  mouse.turn_wheel(-40.0, false);
  DeviceReading reading;
  for (const std::uint32_t held : {0u, 1u, 2u, 4u, 7u}) {
    mouse.set_buttons(held);
    mouse.read(reading);
    EXPECT_EQ(reading.buttons, held);
    EXPECT_EQ(reading.stop_pressed, (held & 4u) != 0);
  }
}

TEST(MouseTest, TheWheelLiftsTheHandWhileNoButtonIsHeld) {
  MouseDevice mouse({}, kRate);
  mouse.turn_wheel(10.0, false);
  mouse.move(0.01, 0.0);
  EXPECT_LT((after(mouse, 3000).tool.position - Vector3d(0.01, 0.02, 0.0)).norm(), 1e-5);
  mouse.turn_wheel(15.0, true);
  mouse.turn_wheel(15.0, false);
  mouse.move(0.01, 0.0);
  EXPECT_LT((after(mouse, 3000).tool.position - Vector3d(0.01, 0.02, 0.0)).norm(), 1e-5)
      << "steps while the button is held change the press";
}

TEST(MouseTest, NonsenseFromTheScreenIsLeftOut) {
  MouseDevice mouse({}, kRate);
  mouse.move(0.01, 0.01);
  mouse.move(kNan, 0.0);
  mouse.press(kNan);
  mouse.press(-5.0);
  const DeviceReading reading = after(mouse, 3000);
  EXPECT_LT((reading.tool.position - Vector3d(0.01, 0.0, 0.01)).norm(), 1e-5);
}

TEST(MouseTest, AnotherThreadMovesIt) {
  MouseDevice mouse({}, kRate);
  std::thread screen([&] {
    for (int i = 0; i <= 10000; ++i) {
      mouse.move(2e-6 * i, -2e-6 * i);
    }
  });
  DeviceReading reading;
  for (int i = 0; i < 10000; ++i) {
    mouse.read(reading);
    mouse.write(Vector3d::Zero());
    ASSERT_NEAR(reading.tool.position.x(), -reading.tool.position.z(), 1.1e-5) << "whole";
  }
  screen.join();
  EXPECT_NEAR(after(mouse, 2000).tool.position.x(), 0.02, 1e-5);
}

TEST(MouseTest, ParametersOutOfBoundsAreRefused) {
  MouseParameters p;
  p.pointer_speed = 0.0;
  EXPECT_THROW(MouseDevice(p, kRate), std::invalid_argument);
  EXPECT_THROW(MouseDevice({}, 0.0), std::invalid_argument);
}

TEST(ReplayTest, GivesEveryStateOnceAndThenEnds) {
  std::vector<PointState> hand;
  for (int i = 0; i < 50; ++i) {
    hand.push_back({{1e-3 * i, -2e-3 * i, 0.0}, {1.0 * i, 0.0, 3.0}});
  }
  ReplayDevice replay(hand, kRate, {"omega.3", 12.0, 0.075, false});
  EXPECT_EQ(replay.duration(), 0.05);
  EXPECT_EQ(replay.info().name, "replay of omega.3");
  EXPECT_TRUE(replay.info().simulated);
  DeviceReading reading;
  for (const PointState& state : hand) {
    ASSERT_TRUE(replay.read(reading));
    ASSERT_TRUE(replay.read(reading)) << "reading again gives the same";
    ASSERT_EQ(reading.tool.position, state.position);
    ASSERT_EQ(reading.tool.velocity, state.velocity);
    ASSERT_STREQ(replay.trouble(), "");
    ASSERT_TRUE(replay.write(Eigen::Vector3d(5.0, 0.0, 0.0)));
  }
  EXPECT_FALSE(replay.read(reading));
  EXPECT_STREQ(replay.trouble(), "the recording has come to its end");
  EXPECT_EQ(reading.tool.position, hand.back().position) << "unchanged";
  EXPECT_TRUE(replay.write(Vector3d::Zero()));
  EXPECT_FALSE(replay.read(reading));
}

/// A hand whose x is the number of its state.
std::vector<PointState> numbered_hand(int states) {
  std::vector<PointState> hand;
  for (int i = 0; i < states; ++i) {
    hand.push_back({{1.0 * i, 0.0, 0.0}, Vector3d::Zero()});
  }
  return hand;
}

TEST(ReplayTest, APassBeginsWhereItBeganHoweverEarlyOrLateItIsAskedFor) {
  ReplayDevice replay(numbered_hand(40), kRate, {}, {10, 25});
  DeviceReading reading;
  const auto tick = [&] {
    EXPECT_TRUE(replay.read(reading));
    replay.write(Vector3d::Zero());
    return reading.tool.position.x();
  };
  for (int i = 0; i < 5; ++i) {
    EXPECT_EQ(tick(), i);
  }
  for (int i = 5; i < 9; ++i) {  // early: the pass waits for the hand
    EXPECT_FALSE(replay.ready());
    EXPECT_EQ(tick(), i);
  }
  EXPECT_TRUE(replay.ready());
  for (int i = 10; i < 24; ++i) {
    EXPECT_EQ(tick(), i);
  }
  for (int i = 0; i < 7; ++i) {  // late: the hand waits for the pass
    EXPECT_EQ(tick(), 24.0);
  }
  EXPECT_TRUE(replay.ready());
  for (int i = 25; i < 40; ++i) {
    EXPECT_FALSE(replay.ready()) << "there is no third pass";
    EXPECT_EQ(tick(), i);
  }
  EXPECT_FALSE(replay.read(reading));
}

TEST(ReplayTest, StartsOutsideTheRecordingOrOutOfOrderAreRefused) {
  EXPECT_THROW(ReplayDevice(numbered_hand(5), kRate, {}, {5}), std::invalid_argument);
  EXPECT_THROW(ReplayDevice(numbered_hand(5), kRate, {}, {3, 1}), std::invalid_argument);
}

TEST(ReplayTest, AnEmptyRecordingIsRefused) {
  EXPECT_THROW(ReplayDevice({}, kRate), std::invalid_argument);
  EXPECT_THROW(ReplayDevice({{}}, 0.0), std::invalid_argument);
}

}  // namespace
}  // namespace haptrial::device::simulated_devices_test
