#include "analysis/bone_drilling/metrics/usage.h"

#include <gtest/gtest.h>

#include <numbers>

#include "tests/analysis/bone_drilling/hand_made.h"

namespace haptrial::analysis::drilling {
namespace {

TEST(UsageTest, TimesForcesAndToolsAddUp) {
  Procedure p = test::procedure_on(test::block(4, 4, 4));
  p.tools = {{"large", 3e-3}, {"small", 1e-3}, {"suction", 0.0}};
  for (std::uint64_t n = 0; n < 1000; ++n) {
    ToolTick tick = test::drilling_tick(n, Eigen::Vector3d::Zero(), n < 500 ? 1.0 : 3.0);
    tick.tool = n < 300 ? 0 : n < 600 ? 1 : n < 900 ? 2 : 1;
    tick.power = n >= 100;
    tick.in_bone = n < 950;
    tick.removed = tick.tool == 2 || n < 100 ? 0.0 : 0.25;
    p.ticks.push_back(tick);
  }
  const Usage found = usage(p);
  EXPECT_DOUBLE_EQ(found.time, 1.0);
  EXPECT_DOUBLE_EQ(found.drilling, 0.55) << "100 to 599 and 900 to 949";
  EXPECT_EQ(found.tool_changes, 3);
  EXPECT_DOUBLE_EQ(found.tools[0].in_hand, 0.3);
  EXPECT_DOUBLE_EQ(found.tools[0].drilling, 0.2);
  EXPECT_DOUBLE_EQ(found.tools[1].in_hand, 0.4);
  EXPECT_DOUBLE_EQ(found.tools[1].drilling, 0.35);
  EXPECT_DOUBLE_EQ(found.tools[2].drilling, 0.0) << "suction does not drill";
  EXPECT_DOUBLE_EQ(*found.mean_force, (400.0 * 1.0 + 150.0 * 3.0) / 550.0);
  EXPECT_DOUBLE_EQ(*found.greatest_force, 3.0);
  EXPECT_NEAR(found.removed, 600 * 0.25 * 1e-9, 1e-18);
}

TEST(UsageTest, BoneIsCountedByStructureAndTool) {
  bone::BoneModel model = test::block(3, 1, 1);
  model.structures.push_back({"nerve", {}, 1.0, true});
  test::mark(model, {2, 0, 0}, 2);
  model.density = {0.5F, 1.0F, 0.25F};
  Procedure p = test::procedure_on(model);
  p.tools.push_back({"small", 5e-4});
  test::remove_in_turn(p, {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}});
  p.ticks[2].tool = 1;
  const Usage found = usage(p);
  EXPECT_EQ(found.structures[1].voxels, 2u);
  EXPECT_NEAR(found.structures[1].volume, 1.5e-9, 1e-18);
  EXPECT_NEAR(found.structures[2].volume, 0.25e-9, 1e-18);
  EXPECT_NEAR(found.tools[0].removed, 1.5e-9, 1e-18);
  EXPECT_NEAR(found.tools[1].removed, 0.25e-9, 1e-18);
}

TEST(UsageTest, TheCamerasWayAndTurns) {
  Procedure p = test::procedure_on(test::block(1, 1, 1));
  const Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  p.views = {{0, {0.1, 0.0, 0.0}, origin}};
  for (std::uint64_t n = 1; n <= 90; ++n) {  // a quarter round the target, in one go
    const double angle = static_cast<double>(n) * std::numbers::pi / 180.0;
    p.views.push_back({100 + n, {0.1 * std::cos(angle), 0.1 * std::sin(angle), 0.0}, origin});
  }
  p.views.push_back({200, p.views.back().eye, origin});                           // at rest
  p.views.push_back({1000, p.views.back().eye + 0.03 * Eigen::Vector3d::UnitZ(),  // and moved on
                     origin + 0.03 * Eigen::Vector3d::UnitZ()});
  const Usage found = usage(p);
  EXPECT_NEAR(found.camera_turn, 0.5 * std::numbers::pi, 1e-9);
  EXPECT_NEAR(found.camera_path, 0.1 * 0.5 * std::numbers::pi + 0.03, 1e-5);
  EXPECT_EQ(found.camera_moves, 2);
}

TEST(UsageTest, NothingHappenedIsNotZeroForce) {
  const Usage found = usage(test::procedure_on(test::block(1, 1, 1)));
  EXPECT_EQ(found.time, 0.0);
  EXPECT_FALSE(found.mean_force);
  EXPECT_FALSE(found.greatest_force);
}

}  // namespace
}  // namespace haptrial::analysis::drilling
