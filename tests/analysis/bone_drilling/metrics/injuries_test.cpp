// A vital structure that is touched at a known instant, removed voxel by voxel, or falls to dust.

#include "analysis/bone_drilling/metrics/injuries.h"

#include <gtest/gtest.h>

#include <numbers>

#include "analysis/bone_drilling/metrics/study_bones.h"
#include "analysis/bone_drilling/metrics/visibility.h"
#include "tests/analysis/bone_drilling/hand_made.h"

namespace haptrial::analysis::drilling::injuries_test {
namespace {

/// A row of 20 voxels; the last two are a nerve, the first two a vein; the ossicle is nowhere.
bone::BoneModel row() {
  bone::BoneModel model = test::block(20, 1, 1);
  model.structures.push_back({"nerve", {}, 1.0, true});
  model.structures.push_back({"canal", {}, 1.0, false});
  model.structures.push_back({"vein", {}, 1.0, true});
  model.structures.push_back({"ossicle", {}, 1.0, true});
  test::mark(model, {18, 0, 0}, 2);
  test::mark(model, {19, 0, 0}, 2);
  test::mark(model, {10, 0, 0}, 3);
  test::mark(model, {0, 0, 0}, 4);
  test::mark(model, {1, 0, 0}, 4);
  return model;
}

TEST(InjuriesTest, AreCountedByStructureWithTheirFirstTimes) {
  StudyBones bones;
  Procedure p = test::procedure_on(row());
  p.tools[0].burr_radius = 1e-4;
  std::vector<bone::Voxel> path;
  for (int i = 5; i < 19; ++i) {
    path.push_back({i, 0, 0});
  }
  test::remove_in_turn(p, path);
  const std::vector<Injury> found = injuries(p, bones);
  ASSERT_EQ(found.size(), 2u) << "the canal is not vital, and of the ossicle nothing is there";
  EXPECT_EQ(found[0].structure, "nerve");
  EXPECT_EQ(found[0].voxels, 1u);
  EXPECT_DOUBLE_EQ(*found[0].first_contact, 0.014) << "the end of tick 14 of 1 ms";
  EXPECT_DOUBLE_EQ(*found[0].first_removal, 0.014);
  EXPECT_EQ(found[1].structure, "vein");
  EXPECT_EQ(found[1].voxels, 0u);
  EXPECT_FALSE(found[1].first_contact);
}

TEST(InjuriesTest, ContactIsWhereTheBurrReachesTheVoxelsCube) {
  // The nerve's first cube begins at 17.5 mm. A burr of 2.3 mm comes by 0.1 mm a tick.
  StudyBones bones;
  Procedure p = test::procedure_on(row());
  p.tools[0].burr_radius = 2.3e-3;
  for (std::uint64_t n = 0; n < 200; ++n) {
    p.ticks.push_back(test::drilling_tick(n, {1e-4 * (static_cast<double>(n) + 0.5), 0.0, 0.0}));
  }
  EXPECT_DOUBLE_EQ(*injuries(p, bones)[0].first_contact, 0.153) << "from 15.2 mm on";
  for (ToolTick& tick : p.ticks) {
    tick.power = false;
  }
  EXPECT_FALSE(injuries(p, bones)[0].first_contact) << "the burr stands";
}

TEST(InjuriesTest, ContactAgreesWithAllVoxels) {
  RandomStream random(9, "contact");
  for (int n = 0; n < 40; ++n) {
    bone::BoneModel model = test::block(8, 7, 9);
    model.structures.push_back({"nerve", {}, 1.0, true});
    const bone::Voxel nerve = test::any_voxel(random, model.grid);
    test::mark(model, nerve, 2);
    Procedure p = test::procedure_on(model);
    p.tools[0].burr_radius = random.uniform(1e-4, 5e-3);
    p.pose_WB = Eigen::Translation3d(0.01, 0.02, 0.03) *
                Eigen::AngleAxisd(random.uniform(0.0, 3.0), Eigen::Vector3d::UnitZ());
    std::optional<double> expected;
    for (std::uint64_t tick = 0; tick < 50; ++tick) {
      const Eigen::Vector3d tip_B(random.uniform(-4e-3, 12e-3), random.uniform(-4e-3, 12e-3),
                                  random.uniform(-4e-3, 12e-3));
      p.ticks.push_back(test::drilling_tick(tick, p.pose_WB * tip_B));
      // The sphere meets the cube where the cube's nearest point lies within it.
      const Eigen::Vector3d middle = model.grid.centre(nerve);
      const Eigen::Vector3d nearest = tip_B.cwiseMax(middle - Eigen::Vector3d::Constant(0.5e-3))
                                          .cwiseMin(middle + Eigen::Vector3d::Constant(0.5e-3));
      if (!expected && (tip_B - nearest).norm() <= p.tools[0].burr_radius) {
        expected = 1e-3 * static_cast<double>(tick + 1);
      }
    }
    StudyBones bones;
    const std::optional<double> found = injuries(p, bones)[0].first_contact;
    ASSERT_EQ(found.has_value(), expected.has_value()) << n;
    if (found) {
      EXPECT_NEAR(*found, *expected, 1e-12) << n;
    }
  }
}

/// A burr that is no ball, against places all over the voxel.
TEST(InjuriesTest, AFissureBurrTouchesByItsShape) {
  RandomStream random(10, "fissure");
  const bone::BurrDimensions fissure{bone::BurrForm::kCylinder, 1.5e-3, 7e-3, 0.0};
  const auto shape = std::make_shared<const bone::BurrShape>(fissure);
  int touched = 0;
  for (int n = 0; n < 60; ++n) {
    bone::BoneModel model = test::block(12, 12, 12);
    model.structures.push_back({"nerve", {}, 1.0, true});
    const bone::Voxel nerve = test::any_voxel(random, model.grid);
    test::mark(model, nerve, 2);
    Procedure p = test::procedure_on(model);
    p.tools[0] = {"fissure", 0.75e-3, shape};
    p.pose_WB = Eigen::Translation3d(0.01, 0.02, 0.03) *
                Eigen::AngleAxisd(random.uniform(0.0, 3.0), Eigen::Vector3d::UnitZ());
    const Eigen::Vector3d middle = model.grid.centre(nerve);
    const Eigen::Vector3d tip_B =
        middle + Eigen::Vector3d(random.uniform(-4e-3, 4e-3), random.uniform(-4e-3, 4e-3),
                                 random.uniform(-4e-3, 4e-3));
    const Eigen::Vector3d axis_B =
        Eigen::Vector3d(random.normal(), random.normal(), random.normal()).normalized();
    p.ticks.push_back(test::drilling_tick(0, p.pose_WB * tip_B));
    p.ticks.back().axis = (p.pose_WB.linear() * axis_B).cast<float>();
    double least = 1.0;  // from a cylinder's axis and ends, over the cube
    constexpr int kSteps = 20;
    for (int i = 0; i <= kSteps * kSteps * kSteps; ++i) {
      const Eigen::Vector3d share(i % kSteps, i / kSteps % kSteps, i / kSteps / kSteps);
      const Eigen::Vector3d from =
          middle + 1e-3 * (share / (kSteps - 1) - Eigen::Vector3d::Constant(0.5)) - tip_B;
      const double along = std::abs(axis_B.dot(from));
      const double across = std::sqrt(std::max(0.0, from.squaredNorm() - along * along));
      const double beyond = std::max(0.0, along - 3.5e-3);
      const double beside = std::max(0.0, across - 0.75e-3);
      least = std::min(least, std::hypot(beyond, beside));
    }
    if (least > 0.0 && least < 0.06e-3) {
      continue;  // the places are no closer to each other
    }
    StudyBones bones;
    const bool found = injuries(p, bones)[0].first_contact.has_value();
    EXPECT_EQ(found, least == 0.0) << n;
    touched += found ? 1 : 0;
  }
  EXPECT_GT(touched, 5);
  EXPECT_LT(touched, 50);
}

TEST(InjuriesTest, WhatFallsToDustIsLostToo) {
  StudyBones bones;
  Procedure p = test::procedure_on(row());
  test::remove_in_turn(p, {{4, 0, 0}, {16, 0, 0}});
  p.crumbs = {{1, {2, 0, 0}}};  // 0 to 3: cut off by the first removal
  const std::vector<Injury> found = injuries(p, bones);
  EXPECT_EQ(found[1].crumbled, 2u);
  EXPECT_EQ(found[1].voxels, 0u);
  EXPECT_EQ(found[0].crumbled, 0u);
}

}  // namespace
}  // namespace haptrial::analysis::drilling::injuries_test
