// How voxels that the cut plane took, and parts that crumbled, count: by hand on small blocks.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "analysis/bone_drilling/metrics/injuries.h"
#include "analysis/bone_drilling/metrics/live.h"
#include "analysis/bone_drilling/metrics/metrics.h"
#include "analysis/bone_drilling/metrics/study_bones.h"
#include "analysis/bone_drilling/metrics/usage.h"
#include "analysis/bone_drilling/metrics/visibility.h"
#include "tests/analysis/bone_drilling/hand_made.h"

namespace haptrial::analysis::drilling {
namespace {

using ::testing::ElementsAre;

/// 9 x 1 x 4 voxels seen from straight above; those with x = 4 in the lowest layer are a nerve.
/// A burr of a tenth of a millimetre, and a plane.
Procedure beam() {
  bone::BoneModel model = test::block(9, 1, 4);
  model.structures.push_back({"nerve", {1.0, 1.0, 0.0}, 1.0, true});
  test::mark(model, {4, 0, 0}, 2);
  Procedure p = test::procedure_on(std::move(model));
  p.tools = {{"burr", 1e-4}, {"plane", 0.0}};
  p.views = {{0, {4e-3, 0.0, 10.0}, Eigen::Vector3d::Zero()}};
  return p;
}

/// The plane in hand on tick n; takes layer x, down to z = `lowest`.
void cut_layer(Procedure& p, std::uint64_t n, int x, int lowest) {
  ToolTick tick;
  tick.sequence = n;
  tick.tool = 1;
  tick.removed = 4.0 - lowest;
  p.ticks.push_back(tick);
  for (int z = 3; z >= lowest; --z) {
    const std::uint8_t label = p.bone->labels[p.bone->grid.index(x, 0, z)];
    p.cuts.push_back({n, {x, 0, z}, label, 0.0, 0.05});
  }
}

TEST(CutsTest, OpenTheViewButNeedNotBeSeen) {
  Procedure p = beam();
  test::remove_in_turn(p, {{3, 0, 0}});  // under three voxels
  cut_layer(p, 1, 4, 1);
  test::remove_in_turn(p, {{4, 0, 0}});  // at the bottom of the cut
  EXPECT_THAT(visibility(p).visible, ElementsAre(0, 1));
}

TEST(CutsTest, CountAsBoneRemovedByStructureAndToolAndAsInjury) {
  Procedure p = beam();
  test::remove_in_turn(p, {{0, 0, 3}});
  p.ticks.back().removed = 1.0;
  cut_layer(p, 1, 4, 0);
  const Usage found = usage(p);
  EXPECT_EQ(found.structures[1].voxels, 1u + 3u);
  EXPECT_EQ(found.structures[2].voxels, 1u);
  EXPECT_NEAR(found.tools[0].removed, 1e-9, 1e-20);
  EXPECT_NEAR(found.tools[1].removed, 4e-9, 1e-20);
  EXPECT_NEAR(found.removed, 5e-9, 1e-20);
  StudyBones bones;
  const auto hurt = injuries(p, bones);
  ASSERT_EQ(hurt.size(), 1u);
  EXPECT_EQ(hurt[0].voxels, 1u);
  EXPECT_EQ(hurt[0].crumbled, 0u);
  EXPECT_DOUBLE_EQ(hurt[0].first_removal.value(), 2e-3);
  EXPECT_FALSE(hurt[0].first_contact) << "no burr was there";
}

/// Two cuts part the middle from the rest: what crumbles is the middle, not the bone.
TEST(CutsTest, WhatCrumblesEndsAtTheCut) {
  Procedure p = beam();
  cut_layer(p, 0, 3, 0);
  cut_layer(p, 1, 5, 0);
  p.crumbs = {{2, {4, 0, 2}}};
  p.ticks.push_back(test::drilling_tick(2, {1.0, 0.0, 0.0}));
  test::remove_in_turn(p, {{2, 0, 3}, {2, 0, 2}});  // still stand, and are seen
  StudyBones bones;
  const auto hurt = injuries(p, bones);
  EXPECT_EQ(hurt[0].crumbled, 1u);
  EXPECT_EQ(hurt[0].voxels, 0u);
  EXPECT_THAT(visibility(p).visible, ElementsAre(1, 1));
  EXPECT_EQ(usage(p).structures[1].voxels, 8u + 2u) << "crumbs are no tool's";
}

TEST(CutsTest, HaveNoForceThatCouldCountNearAStructure) {
  Procedure p = beam();
  test::remove_in_turn(p, {{3, 0, 0}}, 0.5);
  cut_layer(p, 1, 4, 1);
  StudyBones bones;
  MetricOptions options;
  options.near = 2e-3;
  const ProcedureSummary summary = summarize(p, options, bones);
  EXPECT_DOUBLE_EQ(summary.value("near_force").value(), 0.5);
  EXPECT_EQ(summary.removed.size(), 1u);
}

TEST(CutsTest, OfASessionThatRunsAreCounted) {
  Procedure p = beam();
  LiveMetrics live(p.bone, p.pose_WB, p.tools, 1.0, p.rate);
  std::vector<record::Sample> samples(2);
  std::vector<record::ToolRow> tool(2);
  samples[1].sequence = tool[1].sequence = 1;
  tool[0].active = tool[1].active = true;
  const std::vector<record::RemovalRow> rows{{0, 0, {4, 0, 3}, 1, true, 0.0, 0.1},
                                             {0, 0, {4, 0, 2}, 1, true, 0.0, 0.1},
                                             {1, 0, {4, 0, 0}, 2, false, 0x1p-13, 0.1}};
  live.add(std::span<const record::RemovalRow>(rows));
  live.add(samples, tool);
  std::vector<record::CameraRow> camera(1);
  camera[0].eye = {4e-3, 0.0, 10.0};
  live.add(std::span<const record::CameraRow>(camera));
  live.advance(1);
  EXPECT_EQ(live.figures().voxels, 1u);
  EXPECT_EQ(live.figures().visible_share, 0.0) << "one voxel is left above it";
}

}  // namespace
}  // namespace haptrial::analysis::drilling
