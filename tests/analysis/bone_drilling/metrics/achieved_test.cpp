// The achievement of a procedure, against counts and lengths that are found in another way.

#include "analysis/bone_drilling/metrics/achieved.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <set>

#include "analysis/bone_drilling/metrics/metrics.h"
#include "analysis/bone_drilling/metrics/quantities.h"
#include "tests/analysis/bone_drilling/hand_made.h"

namespace haptrial::analysis::drilling::achieved_test {
namespace {

/// A block with a vital nerve along x and a hole of air.
bone::BoneModel block_with_nerve() {
  bone::BoneModel model = test::block(20, 20, 14);
  model.structures.push_back({"facial nerve", {1.0, 1.0, 0.0}, 1.0, true});
  for (int i = 0; i < 20; ++i) {
    test::mark(model, {i, 10, 3}, 2);
  }
  test::mark(model, {5, 5, 12}, 0);
  return model;
}

/// A box from the top of the block down to layer 8.
bool is_planned(const bone::BoneModel& model, int i, int j, int k) {
  const auto& size = model.grid.size;
  const bool inside = i >= 0 && j >= 0 && k >= 0 && i < size[0] && j < size[1] && k < size[2];
  return inside && i >= 4 && i < 15 && j >= 5 && j < 16 && k >= 8 &&
         model.labels[model.grid.index(i, j, k)] == 1;
}

subject::CavityPlan box_plan(const bone::BoneModel& model) {
  std::vector<float> depths;
  for (int k = 0; k < model.grid.size[2]; ++k) {
    for (int j = 0; j < model.grid.size[1]; ++j) {
      for (int i = 0; i < model.grid.size[0]; ++i) {
        depths.push_back(is_planned(model, i, j, k) ? 0.0F : -1.0F);
      }
    }
  }
  return subject::plan_of(model, depths);
}

bool beside_plan(const bone::BoneModel& model, const bone::Voxel& v) {
  for (int n = 0; n < 27; ++n) {
    if (is_planned(model, v.x() + n % 3 - 1, v.y() + n / 3 % 3 - 1, v.z() + n / 9 - 1)) {
      return true;
    }
  }
  return false;
}

TEST(AchievedTest, CountsAreThoseOfTheRecordedRemovals) {
  Procedure p = test::procedure_on(block_with_nerve());
  const bone::BoneModel& model = *p.bone;
  p.plans.cavity = std::make_shared<const subject::CavityPlan>(box_plan(model));
  RandomStream random(4, "removed");
  std::vector<bone::Voxel> voxels;
  for (int n = 0; n < 1500; ++n) {  // some of them more than once
    const bone::Voxel v = test::any_voxel(random, model.grid);
    if (model.labels[model.grid.index(v)] != 0) {
      voxels.push_back(v);
    }
  }
  test::remove_in_turn(p, voxels);
  p.cuts.push_back({p.ticks.back().sequence, {19, 19, 0}, 1, 0.0, 0.0});

  PlanCount expected;
  std::set<std::size_t> seen;
  double least = 1.0;  // distance of centres to the nerve [m]
  voxels.push_back({19, 19, 0});
  for (const bone::Voxel& v : voxels) {
    for (int i = 0; i < 20; ++i) {
      least = std::min(least, 1e-3 * (v - bone::Voxel(i, 10, 3)).cast<double>().norm());
    }
    const std::size_t at = model.grid.index(v);
    if (!seen.insert(at).second) {
      continue;
    }
    if (is_planned(model, v.x(), v.y(), v.z())) {
      ++expected.removed;
    } else if (model.labels[at] == 2) {
      ++expected.injured;
    } else if (!beside_plan(model, v)) {
      ++expected.beyond;
    }
  }
  expected.planned = 11 * 11 * 6 - 1;  // the hole was never bone
  StudyBones bones;
  const Achieved a = summarize(p, {}, bones).achieved;
  ASSERT_TRUE(a.plan);
  EXPECT_EQ(*a.plan, expected);
  EXPECT_GT(expected.beyond, 100u);
  EXPECT_GT(expected.injured, 0u);
  EXPECT_DOUBLE_EQ(*a.removed(), 1e-9 * static_cast<double>(expected.removed));
  ASSERT_EQ(a.left.size(), 1u);
  EXPECT_EQ(a.left[0].thickness, 0.0);
  EXPECT_EQ(least, 0.0);
}

TEST(AchievedTest, ThreeLayersAreLeftOverTheNerve) {
  Procedure p = test::procedure_on(block_with_nerve());
  test::remove_in_turn(p, {{7, 10, 9}, {7, 10, 8}, {7, 10, 7}});
  StudyBones bones;
  const Achieved a = summarize(p, {}, bones).achieved;
  EXPECT_NEAR(*a.left[0].thickness, 3e-3, 1e-12);  // layers 4, 5 and 6
  EXPECT_FALSE(a.plan);
  EXPECT_FALSE(a.economy());
}

// Bones of old sessions have several labels of one name.
TEST(AchievedTest, LabelsOfOneNameAreOneStructure) {
  bone::BoneModel model = block_with_nerve();
  model.structures.push_back(model.structures.back());
  for (int i = 10; i < 20; ++i) {
    test::mark(model, {i, 10, 3}, 3);
  }
  Procedure p = test::procedure_on(model);
  test::remove_in_turn(p, {{15, 10, 7}, {3, 10, 9}});
  StudyBones bones;
  const Achieved a = summarize(p, {}, bones).achieved;
  ASSERT_EQ(a.left.size(), 1u);
  EXPECT_NEAR(*a.left[0].thickness, 3e-3, 1e-12);
  test::remove_in_turn(p, {{3, 10, 3}, {15, 10, 3}});
  const ProcedureSummary opened = summarize(p, {}, bones);
  EXPECT_EQ(judged_quantity(opened, "injured_structures"), 1.0);
}

TEST(AchievedTest, ThePathIsThatOfTheTip) {
  Procedure p = test::procedure_on(block_with_nerve());
  p.plans.cavity = std::make_shared<const subject::CavityPlan>(box_plan(*p.bone));
  const auto tick = [&p](double x, double y, bool drives = true) {
    p.ticks.push_back(test::drilling_tick(p.ticks.size(), {x, y, 0.02}));
    p.ticks.back().drives_tool = drives;
  };
  for (int n = 0; n <= 100; ++n) {  // 30 mm along x, then 40 mm along y
    tick(3e-4 * n, 0.0);
  }
  for (int n = 1; n <= 105; ++n) {
    tick(0.03, 4e-2 * n / 105.0);
  }
  for (int n = 0; n < 50; ++n) {  // the hand steers the camera
    tick(0.5 + n, 0.0, false);
  }
  for (int n = 0; n <= 7; ++n) {  // and goes on elsewhere: 7 mm, in less than a step
    tick(0.1 + 1e-3 * n, 0.1);
  }
  test::remove_in_turn(p, {{8, 8, 13}});
  p.ticks.pop_back();
  StudyBones bones;
  const Achieved a = summarize(p, {}, bones).achieved;
  EXPECT_NEAR(a.path, 0.077, 1e-9);
  EXPECT_NEAR(*a.economy(), 1e-9 / 0.077, 1e-15);
}

// Whoever stays out of reach of a structure left more bone over it than any criterion asks for.
TEST(AchievedTest, BoneLeftBeyondTheReachIsJudgedAsMoreThanAnything) {
  Procedure far = test::procedure_on(block_with_nerve()), near = far;
  test::remove_in_turn(near, {{7, 10, 9}});
  StudyBones bones;
  const char* const left = "bone_left_facial_nerve_mm";
  const ProcedureSummary summary = summarize(far, {}, bones);
  EXPECT_EQ(quantity(summary, left), std::nullopt);
  EXPECT_EQ(judged_quantity(summary, left), std::numeric_limits<double>::infinity());
  EXPECT_EQ(judged_quantity(summary, "bone_left_sigmoid_sinus_mm"), std::nullopt);
  EXPECT_EQ(judged_quantity(summarize(near, {}, bones), left), 5.0);
  EXPECT_THAT(quantity_names_on(*far.bone, false), testing::Contains(left));
  EXPECT_THAT(quantity_names_on(*far.bone, false),
              testing::Not(testing::Contains("bone_left_sigmoid_sinus_mm")));
}

TEST(AchievedTest, TheTableHasAColumnForEachFigure) {
  Procedure p = test::procedure_on(block_with_nerve());
  test::remove_in_turn(p, {{7, 10, 9}});
  StudyBones bones;
  const std::string table = metrics_csv(std::vector{summarize(p, {}, bones)});
  EXPECT_NE(table.find(",cavity_removed_percent,beyond_plan_mm3,tool_path_mm,economy_mm3_per_m,"
                       "bone_left_facial_nerve_mm\n"),
            std::string::npos)
      << table;
  EXPECT_NE(table.find(",,,0,,5\n"), std::string::npos) << table;
}

}  // namespace
}  // namespace haptrial::analysis::drilling::achieved_test
