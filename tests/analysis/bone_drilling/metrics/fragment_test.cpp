// The outcome of an osteotomy against motions that are made by hand.

#include "analysis/bone_drilling/metrics/fragment.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "analysis/bone_drilling/metrics/metrics.h"
#include "tests/analysis/bone_drilling/hand_made.h"

namespace haptrial::analysis::drilling::fragment_test {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

/// A block of voxels of 1 mm with a tooth on either side of x = 9.5 mm.
std::shared_ptr<const bone::BoneModel> block_with_teeth() {
  bone::BoneModel model = test::block(20, 12, 10);
  model.structures.push_back({"tooth", {1.0, 1.0, 1.0}, 1.8, true});
  for (const int i : {4, 15}) {
    for (int k = 4; k < 10; ++k) {
      test::mark(model, {i, 6, k}, 2);
    }
  }
  return std::make_shared<const bone::BoneModel>(std::move(model));
}

subject::FragmentPlan plan_on(const bone::BoneModel& model) {
  subject::FragmentPlan plan;
  plan.point = model.grid.centre(9, 6, 5) + Vector3d(0.5e-3, 0.0, 0.0);
  plan.normal = Vector3d::UnitX();
  plan.move = {-1e-3, 0.0, 3e-3};
  plan.turn = {0.0, 0.0, 0.05};
  return plan;
}

record::PieceRow row_of(int piece, const Isometry3d& motion, std::int64_t voxels) {
  record::PieceRow row;
  row.piece = piece;
  row.voxels = voxels;
  const Eigen::AngleAxisd turn(motion.linear());
  row.turn = turn.angle() * turn.axis();
  row.shift = motion.translation();
  return row;
}

class FragmentTest : public ::testing::Test {
 protected:
  std::shared_ptr<const bone::BoneModel> bone_{block_with_teeth()};
  subject::FragmentPlan plan_{plan_on(*bone_)};
  FragmentMeter meter_{bone_, Isometry3d::Identity(), plan_};
};

TEST_F(FragmentTest, AFragmentThatLiesAsPlannedHasNoError) {
  meter_.add(row_of(1, plan_.motion(), 800));
  const FragmentFit fit = meter_.fit();
  ASSERT_TRUE(fit.came_off);
  EXPECT_NEAR(fit.gap, 0.0, 1e-12);
  EXPECT_NEAR(fit.step, 0.0, 1e-12);
  EXPECT_NEAR(fit.turn, 0.0, 1e-7);
  EXPECT_NEAR(fit.bite_most.value(), 0.0, 1e-12);
}

TEST_F(FragmentTest, GapStepAndTurnAreThoseOfTheError) {
  Isometry3d error = Isometry3d::Identity();  // about where the middle of the cut is to come
  const Vector3d middle = plan_.point + plan_.move;
  error.linear() = Eigen::AngleAxisd(0.03, Vector3d(0.0, 1.0, 0.0)).toRotationMatrix();
  error.translation() = middle + Vector3d(0.4e-3, 0.3e-3, -0.4e-3) - error.linear() * middle;
  meter_.add(row_of(1, Isometry3d::Identity(), 800));
  meter_.add(row_of(2, Isometry3d::Identity(), 30));  // a splinter does not count
  meter_.add(row_of(1, error * plan_.motion(), 0));
  const FragmentFit fit = meter_.fit();
  EXPECT_NEAR(fit.gap, 0.4e-3, 1e-9);
  EXPECT_NEAR(fit.step, 0.5e-3, 1e-9);
  EXPECT_NEAR(fit.turn, 0.03, 1e-9);
  double most = 0.0;
  for (int k = 4; k < 10; ++k) {
    const Vector3d planned = plan_.motion() * bone_->grid.centre(15, 6, k);
    most = std::max(most, (error * planned - planned).norm());
  }
  EXPECT_NEAR(fit.bite_most.value(), most, 1e-12);
  EXPECT_LT(fit.bite_mean.value(), most);
}

/// The larger side stays in the holder, so that the other one comes off and is moved.
TEST_F(FragmentTest, AFragmentThatIsTheLargerSideIsJudgedByTheOthersMotion) {
  plan_.point.x() -= 4e-3;
  FragmentMeter meter(bone_, Isometry3d::Identity(), plan_);
  meter.add(row_of(1, plan_.motion().inverse(), 500));
  const FragmentFit fit = meter.fit();
  EXPECT_NEAR(fit.gap, 0.0, 1e-9);
  EXPECT_NEAR(fit.step, 0.0, 1e-9);
  EXPECT_NEAR(fit.turn, 0.0, 1e-7);
  FragmentMeter wrong(bone_, Isometry3d::Identity(), plan_);
  wrong.add(row_of(1, plan_.motion(), 500));
  EXPECT_GT(wrong.fit().step + std::abs(wrong.fit().gap), 2e-3)
      << "moved as if it were the fragment";
}

TEST_F(FragmentTest, WithoutAPieceOnlyTheCutIsKnown) {
  meter_.remove({9, 3, 3});   // 0.5 mm before the plane
  meter_.remove({12, 3, 3});  // 2.5 mm behind it
  const FragmentFit fit = meter_.fit();
  EXPECT_FALSE(fit.came_off);
  EXPECT_FALSE(fit.bite_mean);
  EXPECT_NEAR(fit.off_cut.value(), 1e-3 * std::sqrt(0.5 * (0.25 + 6.25)), 1e-12);
}

TEST_F(FragmentTest, TheLastRowOfAHoleCountsAndWeakScrewsDoNotHold) {
  const auto screw = [](int hole, int piece, double purchase) {
    return record::ScrewRow{0, 3, 0, hole, piece, 7e-3, purchase, 0.3};
  };
  meter_.add(screw(0, 0, 0.5e-3));
  meter_.add(screw(0, 0, 4e-3));
  meter_.add(screw(1, 1, 3e-3));
  meter_.add(screw(2, 1, 1e-3));
  const FragmentFit fit = meter_.fit();
  EXPECT_EQ(fit.screws, 2);
  EXPECT_EQ(fit.screws_in_bone, 1);
  EXPECT_NEAR(fit.purchase, 8e-3, 1e-12);
}

TEST_F(FragmentTest, ScrewsWhosePlateCameOffDoNotHold) {
  for (const int plate : {0, 1}) {
    for (const int hole : {0, 1}) {
      meter_.add(record::ScrewRow{10, 3, plate, hole, hole, 7e-3, 4e-3, 0.3});
    }
  }
  for (const int hole : {0, 1}) {
    meter_.add(record::ScrewRow{20, 3, 0, hole, -1, 0.0, 0.0, 0.0});
  }
  const FragmentFit fit = meter_.fit();
  EXPECT_EQ(fit.screws, 2);
  EXPECT_EQ(fit.screws_in_bone, 1);
  EXPECT_NEAR(fit.purchase, 8e-3, 1e-12);
}

TEST_F(FragmentTest, FiguresAreThoseOfAnOsteotomyOnlyWhereOneIsPlanned) {
  Procedure p = test::procedure_on(*bone_);
  const auto columns = [](const Procedure& procedure) {
    StudyBones bones;
    std::string all;
    for (const AchievedFigure& f : figures_of(summarize(procedure, {}, bones).achieved)) {
      all += f.column + (f.value ? "=1 " : "=0 ");
    }
    return all;
  };
  EXPECT_EQ(columns(p).find("fragment"), std::string::npos);
  p.plans.fragment = plan_;
  EXPECT_NE(columns(p).find("fragment_gap_mm=0"), std::string::npos);
  p.pieces.push_back(row_of(1, plan_.motion(), 800));
  EXPECT_NE(columns(p).find("fragment_gap_mm=1"), std::string::npos);
}

}  // namespace
}  // namespace haptrial::analysis::drilling::fragment_test
