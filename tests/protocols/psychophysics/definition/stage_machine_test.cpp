#include "protocols/psychophysics/definition/stage_machine.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <stdexcept>

#include "core/scene/scene.h"
#include "tests/support/allocation_guard.h"

namespace haptrial::protocols {
namespace {

using State = StageMachine::State;

constexpr double kDt = 1e-3;

scene::Field floor_field() {
  scene::SurfaceParameters floor;
  floor.shape = scene::HalfSpace{};
  floor.gains = {500.0, 0.0};
  return {.name = "floor", .kind = floor, .fade_in = 0.0, .fade_out = 0.0};
}

/// At least this depth in the first field, or the interval again.
Requirement depth_of(double at_least) {
  return {.of = Requirement::Quantity::kDepth, .field = 0, .at_least = at_least};
}

class StageMachineTest : public testing::Test {
 protected:
  StageMachineTest() : scene_({floor_field()}, 1.0 / kDt) {}

  /// A machine with one region, a ball of 1 cm about the origin.
  StageMachine machine(std::vector<Stage> stages) {
    return {std::move(stages), {{scene::PlacedShape(scene::Sphere{{0.0, 0.0, 0.0}, 0.01}), 0}}, 1};
  }
  /// Ticks until the machine is no longer running. @returns how many
  int run(StageMachine& m, const std::function<device::DeviceReading(double)>& at,
          int most = 100000) {
    m.begin({&scene_, 1}, repeats_);
    int ticks = 0;
    while (m.state() == State::kRunning && ticks < most) {
      const device::DeviceReading reading = at(ticks * kDt);
      scene_.force(reading.tool);
      m.tick({&reading, 1}, {&scene_, 1}, kDt);
      ++ticks;
    }
    return ticks;
  }
  static device::DeviceReading at_height(double y, double velocity = 0.0) {
    device::DeviceReading reading;
    reading.tool.position.y() = y;
    reading.tool.velocity.y() = velocity;
    return reading;
  }

  scene::Scene scene_;
  int repeats_{0};
};

TEST_F(StageMachineTest, AStageOfATimeLastsAsManyTicks) {
  Stage stage;
  stage.until.time = 0.25;
  StageMachine m = machine({stage, stage});
  EXPECT_EQ(run(m, [](double) { return at_height(1.0); }), 500);
  EXPECT_EQ(m.state(), State::kDone);
  EXPECT_EQ(m.times()[0].begin, 0);
  EXPECT_EQ(m.times()[0].end, 249);
  EXPECT_EQ(m.times()[1].begin, 250);
  EXPECT_EQ(m.times()[1].how, StageEnd::kReached);
}

TEST_F(StageMachineTest, AMeasuredValueEndsAStageAndOneThatIsMissingNever) {
  Stage stage;
  stage.until.channel = 1;
  stage.until.above = 2.0;
  stage.timeout = 0.5;
  StageMachine m = machine({stage});
  std::array<double, 2> values{9.0, 0.0};
  const auto with_values = [&](double t) {
    values[1] = t < 0.3 - 1e-9 ? NAN : 2.5;
    device::DeviceReading reading = at_height(1.0);
    reading.channels = values;
    return reading;
  };
  EXPECT_EQ(run(m, with_values), 301);
  EXPECT_EQ(m.times()[0].how, StageEnd::kReached);
  EXPECT_EQ(run(m, [](double) { return at_height(1.0); }), 500) << "there is no channel";
  EXPECT_EQ(m.times()[0].how, StageEnd::kLate);
}

TEST_F(StageMachineTest, AnySampleOfTheStageEndsItUnlessItsValueHasToHold) {
  Stage stage;
  stage.until.channel = 0;
  stage.until.above = 2.0;
  stage.timeout = 0.5;
  const std::array<double, 1> values{0.0};
  std::array<device::ArrivedValue, 3> together{{{0, 0.0, 0.005}, {0, 2.5, 0.004}, {0, 0.0, 0.003}}};
  const auto squeezed = [&](double t) {
    device::DeviceReading reading = at_height(1.0);
    reading.channels = values;
    if (std::abs(t - 0.3) < 1e-9 || t < 1e-9) {  // those of the first tick are of a stage before
      reading.arrived = together;
    }
    return reading;
  };
  StageMachine any = machine({stage});
  EXPECT_EQ(run(any, squeezed), 301);
  EXPECT_EQ(any.times()[0].how, StageEnd::kReached);
  stage.until.hold = 0.002;
  StageMachine held = machine({stage});
  run(held, squeezed);
  EXPECT_EQ(held.times()[0].how, StageEnd::kLate);
}

TEST_F(StageMachineTest, WhatHasToHoldHoldsWithoutABreak) {
  Stage stage;
  stage.until.inside = 0b1;
  stage.until.hold = 0.1;
  StageMachine m = machine({stage});
  // The hand is in the ball from 0.2 s on, but for one tick at 0.25 s.
  const int ticks = run(m, [](double t) {
    const bool out = t < 0.2 - 1e-9 || std::abs(t - 0.25) < 1e-9;
    return at_height(out ? 0.02 : 0.005);
  });
  EXPECT_EQ(m.times()[0].end, 351) << "again from 0.251 s on, for 0.1 s";
  EXPECT_EQ(ticks, 352);
}

TEST_F(StageMachineTest, TheTimeIsAConditionThatHasToHoldLikeTheOthers) {
  Stage wait;
  wait.until.time = 1.0;
  wait.until.hold = 0.5;
  StageMachine alone = machine({wait});
  EXPECT_EQ(run(alone, [](double) { return at_height(1.0); }), 1500);
  wait.until.inside = 0b1;
  StageMachine inside = machine({wait});
  EXPECT_EQ(run(inside, [](double) { return at_height(0.005); }), 1500);
  // The hand comes into the ball only at 1.2 s, on the tick after 1200 others.
  EXPECT_EQ(run(inside, [](double t) { return at_height(t < 1.2 - 1e-9 ? 0.02 : 0.005); }), 1701);
}

TEST_F(StageMachineTest, SpeedsAndContactEndAStage) {
  Stage rest;
  rest.until.speed_below = 0.01;
  Stage touch;
  touch.fields = 1;
  touch.until.contact = 0b1;
  StageMachine m = machine({rest, touch});
  run(m, [](double t) { return at_height(0.03 - 0.1 * t, t < 0.1 - 1e-9 ? -0.1 : 0.0); });
  EXPECT_EQ(m.times()[0].end, 100);
  EXPECT_NEAR(static_cast<double>(m.times()[1].end), 300.0, 1.0) << "the floor is at 0";
}

TEST_F(StageMachineTest, AButtonThatWasHeldBeforeDoesNotCount) {
  Stage stage;
  stage.until.buttons = 0b10;
  StageMachine m = machine({stage, stage});
  run(m, [](double t) {
    device::DeviceReading reading = at_height(1.0);
    const bool down = t < 0.05 || (t > 0.1 && t < 0.2) || t > 0.3;
    reading.buttons = down ? 0b11 : 0;
    return reading;
  });
  EXPECT_EQ(m.state(), State::kDone);
  EXPECT_EQ(m.times()[0].end, 101) << "not by what was held from the first tick on";
  EXPECT_EQ(m.times()[1].end, 301) << "not by the press that ended the stage before";
}

TEST_F(StageMachineTest, AKeyOfTheWindowCountsTheSame) {
  Stage stage;
  stage.until.keys = 0b100;
  StageMachine m = machine({stage});
  run(m, [](double t) {
    device::DeviceReading reading = at_height(1.0);
    reading.keys = t > 0.2 ? 0b100 : 0b011;
    return reading;
  });
  EXPECT_EQ(m.times()[0].end, 201);
}

TEST_F(StageMachineTest, LateStagesGoOnAbortOrRepeat) {
  Stage stage;
  stage.until.inside = 0b1;
  stage.timeout = 0.05;
  const auto outside = [](double) { return at_height(1.0); };
  stage.late = Consequence::kGoOn;
  StageMachine goes_on = machine({stage});
  EXPECT_EQ(run(goes_on, outside), 50);
  EXPECT_EQ(goes_on.state(), State::kDone);
  EXPECT_EQ(goes_on.times()[0].how, StageEnd::kLate);
  stage.late = Consequence::kAbort;
  StageMachine aborts = machine({stage});
  EXPECT_EQ(run(aborts, outside), 50);
  EXPECT_EQ(aborts.state(), State::kAborted);
  EXPECT_EQ(aborts.outside().region, 0);
  EXPECT_GT(aborts.outside().distance, 0.0);
  EXPECT_EQ(goes_on.outside().region, 0);
  stage.late = Consequence::kRepeat;
  repeats_ = 3;
  StageMachine repeats = machine({stage});
  EXPECT_EQ(run(repeats, outside), 200) << "once and three times more";
  EXPECT_EQ(repeats.state(), State::kAborted);
  EXPECT_EQ(repeats.repeats(), 3);
}

TEST_F(StageMachineTest, ARepeatedIntervalHasItsPulseAgain) {
  scene_ = scene::Scene({{.name = "pulse",
                          .kind = scene::PulseParameters{{0.0, 3.0, 0.0}, 0.02, 0.01},
                          .fade_in = 0.0,
                          .fade_out = 0.0}},
                        1.0 / kDt);
  Stage stage;
  stage.fields = 1;
  stage.until.inside = 0b1;
  stage.timeout = 0.05;
  stage.late = Consequence::kRepeat;
  repeats_ = 2;
  StageMachine m = machine({stage});
  double impulse = 0.0;
  run(m, [&](double) {
    impulse += kDt * scene_.state(0).force.y();  // of the tick before
    return at_height(0.02);
  });
  EXPECT_NEAR(impulse, 3 * 3.0 * 0.01, 1e-9) << "once and twice more";
}

TEST_F(StageMachineTest, WhoDidNotPressGetsTheIntervalAgain) {
  Stage press;
  press.fields = 1;
  press.until.time = 0.1;
  press.require = depth_of(0.005);
  repeats_ = 1;
  StageMachine m = machine({press});
  // 4 mm deep at first, then 6 mm.
  EXPECT_EQ(run(m, [](double t) { return at_height(t < 0.1 - 1e-9 ? -0.004 : -0.006); }), 200);
  EXPECT_EQ(m.state(), State::kDone);
  EXPECT_EQ(m.repeats(), 1);
  EXPECT_NEAR(m.times()[0].most, 0.006, 1e-12);
  EXPECT_EQ(m.times()[0].begin, 100);
}

TEST_F(StageMachineTest, TheOnsetOfAMovementIsKnownToTheTick) {
  Stage reach;
  reach.until.inside = 0b1;
  reach.onset_speed = 0.03;
  StageMachine m = machine({reach});
  // The hand starts from rest with 0.2 m/s²: faster than 0.03 m/s after 0.15 s.
  run(m, [](double t) { return at_height(0.1 - 0.1 * t * t, -0.2 * t); });
  EXPECT_EQ(m.times()[0].onset, 151);
  EXPECT_NEAR(static_cast<double>(m.times()[0].end), 1e3 * std::sqrt(0.09 / 0.1), 1.0);
}

TEST_F(StageMachineTest, FieldsActInTheirStagesAlone) {
  Stage off;
  off.until.time = 0.01;
  Stage on = off;
  on.fields = 1;
  StageMachine m = machine({off, on, off});
  m.begin({&scene_, 1}, 0);
  const device::DeviceReading deep = at_height(-0.004);
  for (int k = 0; k < 30; ++k) {
    const double force = scene_.force(deep.tool).y();
    EXPECT_NEAR(force, k >= 10 && k < 20 ? 2.0 : 0.0, 1e-9) << k;
    m.tick({&deep, 1}, {&scene_, 1}, kDt);
  }
}

TEST_F(StageMachineTest, WhatIsNotThereIsNamed) {
  Stage stage;
  stage.until.inside = 0b10;
  EXPECT_THAT(
      [&] {
        machine({Stage{}, stage});
      },
      testing::ThrowsMessage<std::invalid_argument>("stage 2: its region is not there"));
  stage = {};
  stage.require = Requirement{.of = Requirement::Quantity::kForce, .at_least = 1.0};
  EXPECT_THROW(machine({stage}), std::invalid_argument);
  EXPECT_THROW(machine({}), std::invalid_argument);
}

TEST_F(StageMachineTest, ATickDoesNotAllocate) {
  Stage stage;
  stage.until.time = 0.01;
  stage.fields = 1;
  stage.require = depth_of(0.1);
  StageMachine m = machine({stage, stage});
  const device::DeviceReading reading = at_height(-0.001);
  const test::AllocationGuard guard;
  m.begin({&scene_, 1}, 2);
  for (int k = 0; k < 100; ++k) {
    scene_.force(reading.tool);
    m.tick({&reading, 1}, {&scene_, 1}, kDt);
  }
  EXPECT_EQ(guard.count(), 0U);
}

/// A floor at 0 that two fingertips feel, and one that the second alone feels.
class TwoDevicesTest : public testing::Test {
 protected:
  TwoDevicesTest() {
    scene::Field own = floor_field();
    own.name = "own";
    const std::vector<scene::Field> fields{floor_field(), own};
    for (int i = 0; i < 2; ++i) {
      scenes_.emplace_back(fields, 1.0 / kDt);
    }
  }
  StageMachine machine(const Stage& stage) {
    const scene::PlacedShape ball(scene::Sphere{{0.0, 0.0, 0.0}, 0.01});
    return {{stage}, {{ball, 0}, {ball, 1}}, 2, {0b01, 0b11}};
  }
  /// Ticks until the machine is done, the heights of the tips given by time.
  int run(StageMachine& m, const std::function<std::array<double, 2>(double)>& heights) {
    m.begin(scenes_, 0);
    int ticks = 0;
    for (; m.state() == State::kRunning && ticks < 10000; ++ticks) {
      std::array<device::DeviceReading, 2> readings;
      for (std::size_t i = 0; i < 2; ++i) {
        readings[i].tool.position.y() = heights(ticks * kDt)[i];
        scenes_[i].force(readings[i].tool);
      }
      m.tick(readings, scenes_, kDt);
    }
    return ticks;
  }
  std::vector<scene::Scene> scenes_;
};

TEST_F(TwoDevicesTest, EachRegionIsAskedOfItsOwnTool) {
  Stage stage;
  stage.until.inside = 0b11;
  StageMachine both = machine(stage);
  EXPECT_EQ(run(both,
                [](double t) {
                  return std::array{t < 0.1 - 1e-9 ? 0.05 : 0.0, t < 0.3 - 1e-9 ? 0.05 : 0.0};
                }),
            301);
  stage.until.inside = 0b10;
  StageMachine second = machine(stage);
  EXPECT_EQ(run(second,
                [](double t) {
                  return std::array{0.05, t < 0.2 - 1e-9 ? 0.05 : 0.0};
                }),
            201);
}

TEST_F(TwoDevicesTest, ContactIsThatOfEveryDeviceThatFeelsTheField) {
  Stage stage;
  stage.fields = 0b11;
  stage.until.contact = 0b01;
  StageMachine both = machine(stage);
  const auto tips = [](double t) {
    return std::array{t < 0.1 - 1e-9 ? 0.01 : -0.001, t < 0.3 - 1e-9 ? 0.01 : -0.001};
  };
  EXPECT_NEAR(run(both, tips), 301, 1);
  stage.until.contact = 0b10;  // felt by the second alone
  StageMachine second = machine(stage);
  EXPECT_NEAR(run(second,
                  [](double t) {
                    return std::array{0.05, t < 0.2 - 1e-9 ? 0.01 : -0.001};
                  }),
              201, 1);
}

TEST_F(TwoDevicesTest, AFieldOfOneDeviceDoesNotPushTheOther) {
  Stage stage;
  stage.fields = 0b10;
  stage.until.time = 0.1;
  StageMachine m = machine(stage);
  run(m, [](double) { return std::array{-0.002, -0.002}; });
  EXPECT_EQ(scenes_[0].state(1).force.norm(), 0.0);
  EXPECT_NEAR(scenes_[1].state(1).force.y(), 500.0 * 0.002, 1e-12);
}

}  // namespace
}  // namespace haptrial::protocols
