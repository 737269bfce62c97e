// Screws against integrals that are known, and holes that they must not take.

#include "core/bone/simulator/screws.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/core/bone/model/pieces_support.h"
#include "tests/support/allocation_guard.h"

namespace haptrial::bone::screws_test {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double kCortex = 3e-3;
constexpr double kMarrow = 0.4;  // density

/// A block of 32 voxels of 0.5 mm whose uppermost 3 mm are cortex, over marrow.
BoneModel layered() {
  BoneModel model = test::make_box({32, 32, 32});
  model.density.assign(model.grid.count(), 1.0F);
  test::for_each_voxel(model.grid, [&](const Voxel& v) {
    const bool marrow = v.z() < 32 - 6;
    model.density[model.grid.index(v)] = marrow ? static_cast<float>(kMarrow) : 1.0F;
  });
  return model;
}

class ScrewsTest : public ::testing::Test {
 protected:
  ScrewsTest() : world_(layered()) {
    PlateTool plate;
    plate.holes = 2;
    models_.push_back(std::make_unique<PlateModel>(make_plate_model("plate", plate)));
    pose_.translation() = world_.volume(0).grid().centre(16, 16, 31) + 0.25e-3 * Vector3d::UnitZ();
    EXPECT_EQ(attach(*models_[0], 0, pose_, world_), 0);
  }

  ToolState at_hole(std::size_t hole, double tilt = 0.0) const {
    ToolState state;
    state.tip.position = pose_ * models_[0]->holes()[hole].translation();
    state.orientation = Eigen::AngleAxisd(tilt, Vector3d::UnitX());
    return state;
  }
  void drive(const ToolState& state, double seconds) {
    for (int tick = 0; tick < 1000.0 * seconds; ++tick) {
      screws_.begin_tick();
      screws_.drive(world_, models_, tool_, 1, state, 1.0, 1e-3);
      ended_ += screws_.ended() != nullptr ? 1 : 0;
    }
  }

  BoneWorld world_;
  std::vector<std::unique_ptr<PlateModel>> models_;
  Isometry3d pose_{Isometry3d::Identity()};
  ScrewTool tool_;
  Screws screws_;
  int ended_{0};
};

TEST_F(ScrewsTest, PurchaseIsTheIntegralOfDensityAndTorqueFollowsIt) {
  drive(at_hole(0), 6.0);
  ASSERT_EQ(screws_.count(), 1);
  const Screw& screw = screws_.screw(0);
  EXPECT_EQ(ended_, 1);
  EXPECT_EQ(screw.piece, 0);
  EXPECT_DOUBLE_EQ(screw.depth, tool_.length);
  const double expected = kCortex + kMarrow * (tool_.length - kCortex);
  EXPECT_NEAR(screw.purchase, expected, 0.1e-3);  // the plate's samples stand out of the bone
  EXPECT_NEAR(screw.torque, tool_.torque_rate * screw.purchase, 1e-12);
}

TEST_F(ScrewsTest, AScrewGoesByItsPitchAndGoesOnWhereItWasLeft) {
  drive(at_hole(0), 1.0);
  EXPECT_NEAR(screws_.screw(0).depth, tool_.pitch * tool_.turns, 1e-9);
  drive(at_hole(1), 0.5);
  EXPECT_EQ(screws_.count(), 2);
  EXPECT_EQ(ended_, 1);  // the first one was left
  drive(at_hole(0), 0.5);
  EXPECT_EQ(screws_.count(), 2);
  EXPECT_NEAR(screws_.screw(0).depth, 1.5 * tool_.pitch * tool_.turns, 1e-9);
}

TEST_F(ScrewsTest, NoScrewGoesInAslantBesideAHoleOrWithoutAPlate) {
  drive(at_hole(0, 0.5), 0.2);
  ToolState beside = at_hole(0);
  beside.tip.position.y() += 3e-3;
  drive(beside, 0.2);
  world_.detach_plate(0);
  drive(at_hole(0), 0.2);
  EXPECT_EQ(screws_.count(), 0);
}

TEST_F(ScrewsTest, ATickDoesNotAllocate) {
  const ToolState state = at_hole(0);
  test::AllocationGuard guard;
  drive(state, 0.5);
  EXPECT_EQ(guard.count(), 0U);
}

TEST(BentPlateTest, HolesLieOnTheArcAndKeepTheirDistance) {
  PlateTool tool;
  tool.curvature = 40.0;
  const PlateModel plate = make_plate_model("plate", tool);
  const double radius = 1.0 / tool.curvature;
  ASSERT_EQ(plate.holes().size(), 4U);
  for (const Isometry3d& hole : plate.holes()) {
    const Vector3d from = hole.translation() + radius * Vector3d::UnitZ();
    EXPECT_NEAR(from.norm(), radius, 1e-12);
    EXPECT_NEAR(hole.linear().col(2).dot(from / radius), 1.0, 1e-12);
  }
  const double angle =
      std::acos(plate.holes()[1].linear().col(2).dot(plate.holes()[2].linear().col(2)));
  EXPECT_NEAR(radius * angle, 9e-3, 1e-9);  // of the middle holes
}

}  // namespace
}  // namespace haptrial::bone::screws_test
