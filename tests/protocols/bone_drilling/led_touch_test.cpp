// Forces on a hand that is led, held against those on the hand that leads with the same tool at the
// same place in the same tick: to the bit.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>

#include "core/sound/drill_sound.h"
#include "protocols/bone_drilling/led_pass.h"
#include "tests/protocols/drilling_fixture.h"
#include "tests/support/allocation_guard.h"

namespace haptrial::protocols::led_touch_test {
namespace {

using Eigen::Vector3d;

constexpr double kTearsAt = 1.5;           // [N]
constexpr double kTop = 0.0;               // of the tissue and of the bone, in W [m]
constexpr std::uint32_t kPower = 1U << 0;  // buttons, as the fixture has them
constexpr std::uint32_t kNext = 1U << 1;

/// Soft tissue where x < 0, bone elsewhere, both below kTop: 24 x 12 x 12 voxels of 0.5 mm.
bone::BoneModel half_and_half() {
  bone::BoneModel model;
  model.name = "half and half";
  model.source = "made by a test";
  model.grid = {{24, 12, 12}, {0.0, 0.0, 0.0}, 5e-4};
  model.labels.assign(model.grid.count(), 0);
  for (int k = 0; k < 12; ++k) {
    for (int j = 0; j < 6; ++j) {
      for (int i = 0; i < 24; ++i) {
        model.labels[model.grid.index(i, j, k)] = i < 12 ? 2 : 1;
      }
    }
  }
  model.structures = {{},
                      {"bone", {0.9, 0.8, 0.7}, 1.0, false},
                      {"sigmoid sinus and dura", {0.3, 0.4, 0.7}, 0.25, true}};
  return model;
}

bone::SimulatorParameters tools_for(const bone::BoneModel& model) {
  bone::SimulatorParameters p = test::workshop(model);
  bone::ToolSpec plate;
  plate.name = "plate";
  plate.kind = bone::PlateTool{};
  p.tools.push_back(plate);
  bone::SoftTissueParameters dura;
  dura.structure = "dura";
  dura.stiffness = 800.0;
  dura.tears_at = kTearsAt;
  p.soft_tissue = {dura};
  return p;
}

/// One of the two sides, and its bone.
struct Side {
  explicit Side(bool leads) : bone(leads) {
    simulator = std::make_unique<bone::Simulator>(model, tools_for(model));
    companions = std::make_unique<bone::SteppedCompanions>(*simulator, bone::CompanionParameters{},
                                                           1000.0, leads);
    bone.take_new_bone(simulator->checksum());
    bone.prepare_pass(1);
  }
  bone::BoneModel model{half_and_half()};
  std::unique_ptr<bone::Simulator> simulator;
  std::unique_ptr<bone::Companions> companions;
  DrillingLogs logs;
  DrillingParameters parameters{test::by_buttons()};
  SharedBone bone;
};

class LedTouchTest : public testing::Test {
 protected:
  LedTouchTest()
      : own_(*teaches_.simulator, *teaches_.companions, teaches_.parameters, teaches_.logs,
             1000.0) {
    own_.share(teaches_.bone);
    own_.begin(0);
    begin_led(nullptr);
  }
  void begin_led(sound::DrillVibration* vibration) {
    led_ = std::make_unique<LedPass>(LedPass::Parts{*learns_.simulator, *learns_.companions,
                                                    learns_.parameters, learns_.logs, learns_.bone,
                                                    1000.0, 1, false, nullptr, vibration});
    led_->begin(0);
  }
  /// A tick of both hands, over a link without delay.
  void tick(const device::DeviceReading& leads, const device::DeviceReading& is_led) {
    own_out_ = own_.tick(leads, 1e-3);
    std::array<std::byte, 192> room{};
    while (const std::size_t size = teaches_.bone.give(room)) {
      learns_.bone.take(std::span(room).first(size));
    }
    led_out_ = led_->tick(is_led, 1e-3);
  }
  /// Takes a tool in the air. @param times  the next tool is taken in hand
  void take_tool(int times) {
    const Vector3d above(0.0, 0.01, 0.0);
    tick(test::at(above), test::at(above));
    for (int i = 0; i < times; ++i) {
      tick(test::at(above, kNext), test::at(above));
      tick(test::at(above), test::at(above));
    }
  }
  /// Moves both hands down to a depth of the tool's middle and up again, in the same way.
  /// @returns the greatest force
  double press_both(const Vector3d& from, double lowest, std::uint32_t buttons = 0) {
    double most = 0.0;
    for (int i = 0; i <= 1000; ++i) {
      const double share = 1.0 - std::abs(1.0 - i / 500.0);
      const Vector3d p =
          from + Vector3d(0.0, share * (lowest - from.y()), 1e-4 * std::sin(0.05 * i));
      tick(test::at(p, buttons), test::at(p));
      EXPECT_EQ(led_out_.force, own_out_.force) << "tick " << i;
      EXPECT_EQ(led_out_.intent.push, own_out_.intent.push) << "tick " << i;
      most = std::max(most, led_out_.force.norm());
    }
    return most;
  }
  Side teaches_{true};
  Side learns_{false};
  DrillingPass own_;
  std::unique_ptr<LedPass> led_;
  PassOutput own_out_;
  PassOutput led_out_;
};

TEST_F(LedTouchTest, ABurrThatIsStillFeelsBoneAndSoftTissueAsTheOtherHandDoes) {
  take_tool(0);
  EXPECT_GT(press_both({0.003, 0.004, 0.0}, kTop + 1.2e-3), 0.5) << "bone";
  const double soft = press_both({-0.003, 0.004, 0.0}, kTop + 0.1e-3);
  EXPECT_GT(soft, 0.5);
  EXPECT_LT(soft, kTearsAt);
  EXPECT_GT(press_both({0.0, 0.004, 0.0}, kTop + 1.2e-3), 0.1) << "at the border of both";
}

TEST_F(LedTouchTest, ATubeThatSucksIsHeldByTheTissue) {
  take_tool(1);
  double pull = 0.0;
  for (int i = 0; i <= 1000; ++i) {  // down, and up from the tissue that clings to it
    const double y = kTop + 1e-3 + 1e-3 * std::cos(0.002 * std::numbers::pi * i);
    const Vector3d p(-0.003, y, 0.0);
    tick(test::at(p, kPower), test::at(p));
    ASSERT_EQ(led_out_.force, own_out_.force) << "tick " << i;
    pull = std::min(pull, led_out_.force.y());
  }
  EXPECT_LT(pull, -0.1);
  EXPECT_GE(pull, -0.15 - 1e-9) << "where it comes off";
}

TEST_F(LedTouchTest, APlateFeelsTheBone) {
  take_tool(3);
  ASSERT_NE(learns_.simulator->tool().as<bone::PlateTool>(), nullptr);
  EXPECT_GT(press_both({0.003, 0.004, 0.0}, kTop - 1e-3), 0.1);
}

TEST_F(LedTouchTest, TheHandThatIsLedTearsNothingAndIsOnceThroughFree) {
  take_tool(0);
  const std::uint64_t before = learns_.simulator->checksum();
  double most = 0.0;
  double last = 1.0;
  for (int i = 0; i < 1000; ++i) {
    const Vector3d p(-0.003, 0.004 - 6e-6 * i, 0.0);
    tick(test::at({0.0, 0.01, 0.0}, kPower), test::at(p));
    ASSERT_TRUE(learns_.simulator->tears().empty());
    most = std::max(most, led_out_.force.norm());
    last = led_out_.force.norm();
  }
  EXPECT_NEAR(most, kTearsAt, 0.05);
  EXPECT_EQ(last, 0.0);
  EXPECT_EQ(learns_.simulator->checksum(), before);
  tick(test::at({0.0, 0.01, 0.0}), test::at({-0.003, 0.01, 0.0}));
  EXPECT_GT(press_both({-0.003, 0.004, 0.0}, kTop + 0.8e-3), 0.1) << "the tissue is whole";
}

TEST_F(LedTouchTest, AHoleThatTheOtherHandToreIsOneForBoth) {
  take_tool(0);
  bool torn = false;
  for (int i = 0; i < 800; ++i) {
    const Vector3d p(-0.003, 0.004 - 6e-6 * i, 0.0);
    tick(test::at(p), test::at({0.0, 0.01, 0.0}));
    torn = torn || !learns_.simulator->tears().empty();
  }
  EXPECT_TRUE(torn);
  const Vector3d away(0.0, 0.01, 0.0);
  tick(test::at(away), test::at(away));
  for (int i = 0; i < 600; ++i) {
    tick(test::at(away), test::at({-0.003, 0.004 - 6e-6 * i, 0.0}));
    ASSERT_EQ(led_out_.force.norm(), 0.0) << "tick " << i;
  }
}

TEST_F(LedTouchTest, ABurrInBoneShakesThisHandToo) {
  const auto vibration = [] {
    return sound::DrillVibration(sound::default_vibration(), 1.0, 1000.0, 7);
  };
  sound::DrillVibration felt = vibration();
  sound::DrillVibration reference = vibration();
  begin_led(&felt);
  double most = 0.0;
  for (int i = 0; i < 1000; ++i) {
    const Vector3d p(0.003, 0.004 - 3e-6 * i, 0.0);
    tick(test::at({0.0, 0.01, 0.0}, kPower), test::at(p));
    const Vector3d contact = learns_.logs.tool_now().contact;  // recorded without the shaking
    sound::DrillState state;
    state.burr = sound::Burr::kCutting;
    state.speed = 1.0;
    state.contact = !contact.isZero(0.0);
    state.force = contact.norm();
    const ToolState tool{{p, Vector3d::Zero()}, Eigen::Quaterniond::Identity()};
    const Vector3d shake = reference.tick(state, tool);
    ASSERT_LT((led_out_.force - contact - shake).norm(), 1e-12) << "tick " << i;
    most = std::max(most, shake.norm());
  }
  EXPECT_GT(most, 0.01);
}

TEST_F(LedTouchTest, WhatIsFeltGoesOverIfTheOtherHandTakesAnotherTool) {
  take_tool(0);
  const Vector3d away(0.0, 0.01, 0.0);
  Vector3d p(0.003, 0.004, 0.0);
  for (; p.y() > kTop + 1.2e-3; p.y() -= 5e-6) {
    tick(test::at(away), test::at(p));
    ASSERT_FALSE(led_out_.goes_over);
  }
  EXPECT_GT(led_out_.force.norm(), 0.5);
  tick(test::at(away, kNext), test::at(p));
  EXPECT_TRUE(led_out_.goes_over);
  EXPECT_EQ(led_out_.force.norm(), 0.0);
  tick(test::at(away), test::at(p));
  EXPECT_FALSE(led_out_.goes_over);
}

TEST_F(LedTouchTest, ATickDoesNotAllocate) {
  take_tool(0);
  const test::AllocationGuard guard;
  for (int i = 0; i < 300; ++i) {
    const Vector3d p(-0.003, 0.003 - 6e-6 * i, 0.0);
    led_out_ = led_->tick(test::at(p), 1e-3);
  }
  EXPECT_EQ(guard.count(), 0u);
}

}  // namespace
}  // namespace haptrial::protocols::led_touch_test
