// Figures that a session shows while it runs are those of its file afterwards.

#include "analysis/bone_drilling/metrics/live.h"

#include <gtest/gtest.h>

#include "analysis/bone_drilling/metrics/metrics.h"
#include "core/bone/record/drilling_tables.h"
#include "core/bone/record/recorded_bone.h"
#include "core/record/read/session_reader.h"
#include "tests/analysis/bone_drilling/hand_made.h"
#include "tests/analysis/bone_drilling/session_of_drillings.h"

namespace haptrial::analysis::drilling {
namespace {

const std::vector<ProcedureTool> kTools{{"large", 2e-3}, {"small", 1e-3}};

/// A plan that asks for the upper half of a block.
subject::CavityPlan upper_half_plan(const bone::BoneModel& bone) {
  std::vector<float> depths(bone.labels.size(), -1.0F);
  std::fill(depths.begin() + static_cast<std::ptrdiff_t>(depths.size() / 2), depths.end(), 0.0F);
  return subject::plan_of(bone, depths);
}

template <class Row>
std::span<const Row> from(const std::vector<Row>& rows, std::uint64_t first, std::uint64_t end) {
  const auto before = [](const Row& row, std::uint64_t n) { return row.sequence < n; };
  const auto low = std::lower_bound(rows.begin(), rows.end(), first, before);
  return {low, std::lower_bound(low, rows.end(), end, before)};
}

/// Gives rows in pieces of `slice` ticks, removals before the ticks that they belong to.
void feed(LiveMetrics& live, const test::DrillingRows& rows, std::uint64_t slice) {
  const std::uint64_t last = rows.samples.back().sequence;
  for (std::uint64_t at = rows.samples.front().sequence; at <= last; at += slice) {
    live.add(from(rows.removals, at, at + slice));
    live.add(from(rows.splits, at, at + slice));
    live.add(from(rows.samples, at, at + slice), from(rows.tool, at, at + slice));
    live.add(from(rows.camera, at, at + slice));
    live.advance(at + slice - 1);
  }
}

TEST(LiveMetricsTest, EqualsTheAnalysisOfTheFile) {
  const test::TemporaryFolder folder;
  const auto file = folder.path() / "live.h5";
  const std::vector<record::BoneRecord> bones{test::block_record(0)};
  const auto bone = std::make_shared<const bone::BoneModel>(bone::bone_of(bones[0]));
  ProcedureSetup setup;
  setup.scale = 2.0;
  setup.tools = kTools;
  setup.pose_WB = [](const geometry::VoxelGrid&) {
    return Eigen::Isometry3d(Eigen::Translation3d(0.0, 0.0, 1e-4));
  };
  const auto plan = std::make_shared<const subject::CavityPlan>(upper_half_plan(*bone));
  const ProcedurePlans plans{plan, std::nullopt};
  setup.plans = [plans](const auto&) { return plans; };
  LiveMetrics live(bone, setup.pose_WB(bone->grid), kTools, setup.scale, 1000.0, setup.handle,
                   plans);
  {
    record::SessionWriter writer(file, test::drilling_info(), record::drilling_tables(),
                                 record::rows_of(bones));
    RandomStream random(2, "live");
    std::vector<bool> gone;
    record::PassRow pass;
    pass.trial = 1;
    pass.repetition = 1;
    pass.condition = "drilling";
    pass.status = record::PassStatus::kAborted;
    const auto first = test::wander(0, 3000, 0, random, gone);
    test::write_pass(writer, first, pass, 50);
    feed(live, first, 7);
    pass.status = record::PassStatus::kCompleted;
    const auto second = test::wander(3050, 2000, 1, random, gone);
    test::write_pass(writer, second, pass);
    feed(live, second, 333);
    writer.set_timing({}, {5070, 0, 0});
    writer.close();
  }
  const auto procedures = load_procedures(record::SessionReader(file), setup);
  ASSERT_EQ(procedures.size(), 1u);
  ASSERT_GT(procedures[0].crumbs.size(), 1u);
  StudyBones study;
  const ProcedureSummary after = summarize(procedures[0], {}, study);
  const LiveFigures now = live.figures();
  EXPECT_EQ(now.time, after.value("time"));
  EXPECT_EQ(now.drilling, after.value("drilling_time"));
  EXPECT_EQ(1e9 * now.removed, after.value("removed"));
  EXPECT_EQ(now.mean_force, after.value("mean_force"));
  EXPECT_EQ(now.voxels, procedures[0].removals.size());
  EXPECT_EQ(now.visible_share, after.value("visible_share"));
  EXPECT_EQ(static_cast<double>(now.injured_voxels), after.value("injured_voxels"));
  EXPECT_EQ(now.injuries, after.injuries);
  EXPECT_EQ(now.achieved, after.achieved);
  // The equal figures say something.
  EXPECT_NEAR(now.time, 5.0, 1e-9);
  EXPECT_GT(now.voxels, 100u);
  EXPECT_GT(*now.visible_share, 0.02);
  EXPECT_LT(*now.visible_share, 0.98);
  EXPECT_GT(now.injured_voxels, 0u);
  EXPECT_GT(now.achieved.plan->removed, 50u);
  EXPECT_GT(now.achieved.plan->beyond, 0u);
  EXPECT_GT(now.achieved.path, 0.0);
}

TEST(LiveMetricsTest, TheSingleMetricsAgreeWithTheWhole) {
  const auto bone = std::make_shared<const bone::BoneModel>(bone::bone_of(test::block_record(0)));
  RandomStream random(6, "single");
  std::vector<bool> gone;
  const auto rows = test::wander(0, 2000, 0, random, gone);
  Procedure p;
  p.bone = bone;
  p.tools = kTools;
  for (std::size_t i = 0; i < rows.samples.size(); ++i) {
    p.ticks.push_back(tick_of(rows.samples[i], rows.tool[i], 2.0));
  }
  for (const auto& row : rows.removals) {
    p.removals.push_back(removal_of(row));
  }
  for (const auto& row : rows.camera) {
    p.views.push_back(view_of(row));
  }
  StudyBones study;
  const ProcedureSummary all = summarize(p, {}, study);
  EXPECT_EQ(visibility(p).visible, all.visibility.visible);
  EXPECT_EQ(injuries(p, study), all.injuries);
  EXPECT_EQ(usage(p).mean_force, all.usage.mean_force);
  EXPECT_EQ(usage(p).camera_path, all.usage.camera_path);
}

TEST(LiveMetricsTest, WaitsForWhatIsNotCompleteAndRefusesOtherTicks) {
  const auto bone = std::make_shared<const bone::BoneModel>(bone::bone_of(test::block_record(0)));
  LiveMetrics live(bone, Eigen::Isometry3d::Identity(), kTools, 2.0, 1000.0);
  RandomStream random(3, "waits");
  std::vector<bool> gone;
  const auto rows = test::wander(0, 100, 0, random, gone);
  live.add(rows.samples, rows.tool);
  live.advance(49);
  EXPECT_DOUBLE_EQ(live.figures().time, 0.05);
  live.advance(99);
  EXPECT_DOUBLE_EQ(live.figures().time, 0.1);
  EXPECT_FALSE(live.figures().visible_share);
  EXPECT_THROW(live.add(rows.samples, std::span(rows.tool).subspan(1)), std::invalid_argument);
  EXPECT_THROW(live.add(std::span(rows.samples).subspan(1),
                        std::span(rows.tool).first(rows.tool.size() - 1)),
               std::invalid_argument);
}

}  // namespace
}  // namespace haptrial::analysis::drilling
