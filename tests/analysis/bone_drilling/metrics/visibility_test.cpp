// The shelf that hides known voxels, single voxels, and a brute-force line of sight.

#include "analysis/bone_drilling/metrics/visibility.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "tests/analysis/bone_drilling/hand_made.h"

namespace haptrial::analysis::drilling {
namespace {

using test::block;
using test::procedure_on;
using ::testing::ElementsAre;

constexpr double kThin = 1e-4;  // a burr that touches its own voxel only

Procedure seen_from(bone::BoneModel model, const Eigen::Vector3d& eye) {
  Procedure p = procedure_on(std::move(model));
  p.tools = {{"burr", kThin}};
  p.views = {{0, eye, Eigen::Vector3d::Zero()}};
  return p;
}

/// A floor two voxels thick at z = 0 and 1; over its left half, x < 5, a shelf at z = 4.
bone::BoneModel shelf() {
  bone::BoneModel model = block(10, 3, 5);
  for (int j = 0; j < 3; ++j) {
    for (int i = 0; i < 10; ++i) {
      test::mark(model, {i, j, 2}, 0);
      test::mark(model, {i, j, 3}, 0);
      if (i >= 5) {
        test::mark(model, {i, j, 4}, 0);
      }
    }
  }
  return model;
}

TEST(VisibilityTest, AShelfHidesWhatLiesUnderIt) {
  Procedure p = seen_from(shelf(), {4.5e-3, 1e-3, 10.0});  // far above: rays go straight up
  for (int i = 0; i < 10; ++i) {
    test::remove_in_turn(p, {{i, 1, 1}});
  }
  const Visibility found = visibility(p);
  EXPECT_THAT(found.visible, ElementsAre(0, 0, 0, 0, 0, 1, 1, 1, 1, 1));
  EXPECT_DOUBLE_EQ(*found.share(), 0.5);
}

TEST(VisibilityTest, ASaucerIsSeenAndTheSameHoleFromInsideIsNot) {
  Procedure down = seen_from(block(3, 3, 3), {1e-3, 1e-3, 1.0});
  test::remove_in_turn(down, {{1, 1, 2}, {1, 1, 1}, {1, 1, 0}});
  EXPECT_EQ(visibility(down).count, 3u);
  Procedure up = seen_from(block(3, 3, 3), {1e-3, 1e-3, 1.0});
  test::remove_in_turn(up, {{1, 1, 0}, {1, 1, 1}, {1, 1, 2}});
  EXPECT_THAT(visibility(up).visible, ElementsAre(0, 0, 1));
}

TEST(VisibilityTest, BoneThatTheBurrTouchesDoesNotHide) {
  Procedure p = seen_from(block(1, 1, 4), {0.0, 0.0, 1.0});
  test::remove_in_turn(p, {{0, 0, 1}});  // under two voxels, of which the farther begins at 1.5 mm
  p.tools[0].burr_radius = 1.49e-3;
  EXPECT_EQ(visibility(p).count, 0u) << "the last voxel begins 1.5 mm from the burr's centre";
  p.tools[0].burr_radius = 1.51e-3;
  EXPECT_EQ(visibility(p).count, 1u);
  p.ticks.clear();
  EXPECT_EQ(visibility(p).count, 0u) << "without a tick there is no burr";
}

TEST(VisibilityTest, TheViewOfTheTickCounts) {
  Procedure p = seen_from(block(3, 1, 1), {1.0, 0.0, 0.0});
  p.views.push_back({1, {-1.0, 0.0, 0.0}, Eigen::Vector3d::Zero()});
  test::remove_in_turn(p, {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}});
  EXPECT_THAT(visibility(p).visible, ElementsAre(0, 1, 1));
  p.views.erase(p.views.begin());
  p.views.front().sequence = 2;
  EXPECT_THAT(visibility(p).visible, ElementsAre(0, 0, 1)) << "nobody looked before";
  p.removals.clear();
  EXPECT_FALSE(visibility(p).share());
}

TEST(VisibilityTest, APartThatTurnedToDustHidesNoLonger) {
  bone::BoneModel model = shelf();
  Procedure p = seen_from(model, {4.5e-3, 1e-3, 10.0});
  test::remove_in_turn(p, {{0, 1, 1}, {1, 1, 1}});
  p.crumbs = {{1, {3, 0, 4}}};  // the shelf hangs together, and the floor does not hang on it
  EXPECT_THAT(visibility(p).visible, ElementsAre(0, 1));
}

TEST(VisibilityTest, ASurfaceVoxelOfAConvexBoneIsSeenFromOutside) {
  bone::BoneModel ball = block(15, 15, 15);
  for (int k = 0; k < 15; ++k) {
    for (int j = 0; j < 15; ++j) {
      for (int i = 0; i < 15; ++i) {
        if (Eigen::Vector3d(i - 7, j - 7, k - 7).norm() > 7.0) {
          test::mark(ball, {i, j, k}, 0);
        }
      }
    }
  }
  const StandingBone standing(std::make_shared<const bone::BoneModel>(ball));
  const Eigen::Vector3d middle = ball.grid.centre(7, 7, 7);
  int pole = 0;
  for (int axis = 0; axis < 3; ++axis) {
    for (const int side : {-7, 7}) {
      bone::Voxel v(7, 7, 7);
      v[axis] += side;
      const Eigen::Vector3d p = ball.grid.centre(v);
      EXPECT_TRUE(is_visible(standing, v, middle + 20.0 * (p - middle), {}));
      EXPECT_FALSE(is_visible(standing, v, middle - 20.0 * (p - middle), {}));
      ++pole;
    }
  }
  EXPECT_EQ(pole, 6);
}

/// Points along the line, close together.
bool seen_by_sampling(const StandingBone& bone, const bone::Voxel& voxel,
                      const Eigen::Vector3d& eye, const BurrOnTick& burr, bool& unsure) {
  const geometry::VoxelGrid& grid = bone.grid();
  const Eigen::Vector3d from = grid.centre(voxel);
  bool visible = true;
  for (int n = 0; n <= 20000; ++n) {
    const Eigen::Vector3d p = from + (eye - from) * (n / 20000.0);
    const Eigen::Vector3d place = (p - grid.origin) / grid.spacing;
    const bone::Voxel at = place.array().round().cast<int>();
    if (!bone.inside(at)) {
      break;  // a line leaves a box once
    }
    const double edge = 0.5 - (place - at.cast<double>()).cwiseAbs().maxCoeff();
    const bool hides = bone.holds(at) && at != voxel && !burr.touches(grid, at);
    if (hides) {
      visible = false;
      unsure = unsure || edge < 1e-3;
      if (edge >= 1e-3) {
        unsure = false;
        return false;
      }
    }
  }
  return visible;
}

TEST(VisibilityTest, AgreesWithPointsAlongTheLine) {
  RandomStream random(5, "visibility");
  bone::BoneModel model = block(12, 9, 10);
  for (std::uint8_t& label : model.labels) {
    label = random.uniform() < 0.06 ? 1 : 0;
  }
  const StandingBone standing(std::make_shared<const bone::BoneModel>(model));
  int visible = 0;
  int compared = 0;
  for (int n = 0; n < 400; ++n) {
    const bone::Voxel v = test::any_voxel(random, model.grid);
    const Eigen::Vector3d eye(random.uniform(-0.02, 0.03), random.uniform(-0.02, 0.03),
                              random.uniform(-0.02, 0.03));
    const BurrOnTick burr{model.grid.centre(v), random.uniform(0.0, 2e-3)};
    bool unsure = false;
    const bool expected = seen_by_sampling(standing, v, eye, burr, unsure);
    if (!unsure) {
      EXPECT_EQ(is_visible(standing, v, eye, burr), expected) << n;
      ++compared;
      visible += expected ? 1 : 0;
    }
  }
  EXPECT_GT(compared, 380);
  EXPECT_GT(visible, 100);
  EXPECT_LT(visible, 300);
}

TEST(VisibilityTest, ThePoseOfTheBoneChangesNothing) {
  Procedure p = seen_from(shelf(), {4.5e-3, 1e-3, 0.05});
  p.tools[0].burr_radius = 1e-3;
  for (int i = 0; i < 10; ++i) {
    test::remove_in_turn(p, {{i, 1, 1}});
  }
  const Visibility here = visibility(p);
  const Eigen::Isometry3d pose =
      Eigen::Translation3d(0.1, -0.2, 0.05) *
      Eigen::AngleAxisd(0.5 * std::numbers::pi, Eigen::Vector3d::UnitY());
  p.pose_WB = pose;
  for (ToolTick& tick : p.ticks) {
    tick.position = pose * tick.position;
  }
  p.views[0].eye = pose * p.views[0].eye;
  EXPECT_EQ(visibility(p).visible, here.visible);
  EXPECT_GT(here.count, 0u);
  EXPECT_LT(here.count, 10u);
}

}  // namespace
}  // namespace haptrial::analysis::drilling
