// Contents of a session file as read: trials, their passes, their bones.

#include "analysis/bone_drilling/metrics/procedure.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "analysis/bone_drilling/metrics/study_bones.h"
#include "core/base/error.h"
#include "core/bone/record/drilling_tables.h"
#include "core/bone/record/recorded_bone.h"
#include "core/record/read/session_reader.h"
#include "tests/analysis/bone_drilling/session_of_drillings.h"

namespace haptrial::analysis::drilling {
namespace {

using record::PassStatus;
using test::TemporaryFolder;

ProcedureSetup setup() {
  ProcedureSetup setup;
  setup.group = "novices";
  setup.scale = 2.0;
  setup.tools = {{"large", 2e-3}, {"small", 1e-3}};
  setup.pose_WB = [](const geometry::VoxelGrid& grid) {
    return Eigen::Isometry3d(Eigen::Translation3d(grid.spacing, 0.0, 0.0));
  };
  return setup;
}

record::PassRow pass(std::int32_t trial, std::int32_t repetition, PassStatus status) {
  record::PassRow row;
  row.trial = trial;
  row.condition = "drilling";
  row.repetition = repetition;
  row.status = status;
  return row;
}

class ProcedureTest : public ::testing::Test {
 protected:
  std::vector<Procedure> load(const std::vector<record::PassRow>& passes,
                              const std::vector<record::ProcedureRow>& ends = {}) {
    const auto file = folder_.path() / "P07.h5";
    const std::vector<record::BoneRecord> bones{test::block_record(0), test::block_record(1)};
    {
      record::SessionWriter writer(file, test::drilling_info(), record::drilling_tables(),
                                   record::rows_of(bones));
      RandomStream random(1, "procedures");
      std::uint64_t at = 0;
      for (std::size_t n = 0; n < passes.size(); ++n) {
        std::vector<bool> gone;
        rows_.push_back(test::wander(at, 300, static_cast<std::int32_t>(n), random, gone));
        test::write_pass(writer, rows_.back(), passes[n]);
        at += 320;
      }
      writer.add(std::span<const record::ProcedureRow>(ends));
      writer.set_timing({}, {at, 0, 0});
      writer.close();
    }
    return load_procedures(record::SessionReader(file), setup(), &study_);
  }

  TemporaryFolder folder_;
  StudyBones study_;
  std::vector<test::DrillingRows> rows_;
};

TEST_F(ProcedureTest, EachTrialIsOne) {
  const auto found = load({pass(1, 1, PassStatus::kCompleted), pass(2, 1, PassStatus::kCompleted)});
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].session, "P07.h5");
  EXPECT_EQ(found[0].participant, "P07");
  EXPECT_EQ(found[0].group, "novices");
  EXPECT_EQ(found[1].number, 2);
  EXPECT_TRUE(found[1].completed);
  EXPECT_EQ(found[1].pose_WB.translation().x(), 1e-3);
  ASSERT_EQ(found[1].ticks.size(), 300u) << "ticks between passes are none of a drilling";
  EXPECT_EQ(found[1].ticks[0].sequence, 320u);
  EXPECT_EQ(found[1].removals.size(), rows_[1].removals.size());
  EXPECT_EQ(found[1].views.size(), rows_[1].camera.size());
  const record::Sample& sample = rows_[1].samples[17];
  EXPECT_NEAR((found[1].ticks[17].position - 0.5 * sample.position).norm(), 0.0, 1e-6);
  EXPECT_NEAR((found[1].ticks[17].velocity - 0.5 * sample.velocity).norm(), 0.0, 1e-5);
  EXPECT_NEAR(found[1].ticks[17].force, rows_[1].tool[17].contact.norm(), 3e-4);
  EXPECT_EQ(found[1].removals[3].voxel.x(), rows_[1].removals[3].voxel[0]);
}

TEST_F(ProcedureTest, WhatWentOnIsOneAndWhatWasBegunAnewCountsOnce) {
  const auto found = load({pass(1, 1, PassStatus::kAborted), pass(1, 1, PassStatus::kCompleted),
                           pass(2, 1, PassStatus::kAborted), pass(2, 2, PassStatus::kAborted)});
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].ticks.size(), 600u);
  EXPECT_TRUE(found[0].completed);
  EXPECT_EQ(found[0].removals.size(), rows_[0].removals.size() + rows_[1].removals.size());
  EXPECT_EQ(found[1].ticks.size(), 300u);
  EXPECT_EQ(found[1].ticks[0].sequence, 960u) << "the second bone of trial 2";
  EXPECT_FALSE(found[1].completed);
}

TEST_F(ProcedureTest, PracticeIsNoProcedure) {
  record::PassRow practice = pass(1, 1, PassStatus::kCompleted);
  practice.practice = true;
  const auto found = load({practice, pass(1, 1, PassStatus::kCompleted)});
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].ticks[0].sequence, 320u);
}

TEST_F(ProcedureTest, TheBoneIsTheOneOfItsRecordAndKeptOnce) {
  const auto found = load({pass(1, 1, PassStatus::kCompleted), pass(2, 1, PassStatus::kCompleted)});
  EXPECT_EQ(found[0].bone, found[1].bone) << "both records say the same";
  const bone::BoneModel& bone = *found[0].bone;
  EXPECT_EQ(bone.labels.size(), 720u);
  EXPECT_EQ(bone.labels[bone.grid.index(3, 5, 2)], 2);
  EXPECT_EQ(bone.labels[bone.grid.index(3, 4, 2)], 1);
  EXPECT_EQ(bone.density[7], 0.25F);
  EXPECT_EQ(bone.density[8], 1.0F);
  EXPECT_TRUE(bone.structures[2].vital);
  record::BoneRecord other = test::block_record(0);
  other.runs.pop_back();
  EXPECT_NE(study_.keep(bone::bone_of(other)), found[0].bone);
}

TEST_F(ProcedureTest, ABoneThatIsNotThereIsRefused) {
  record::ProcedureRow end;
  end.bone = 2;
  try {
    load({pass(1, 1, PassStatus::kCompleted)}, {end});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("is on bone 2; allowed: 0 to 1"));
  }
}

TEST_F(ProcedureTest, ASessionWithoutDrillingsIsRefused) {
  const auto file = folder_.path() / "other.h5";
  {
    record::SessionWriter writer(file, test::drilling_info());
    writer.close();
  }
  const record::SessionReader reader(file);
  EXPECT_THROW(load_procedures(reader, setup()), InputError);
  ProcedureSetup flat = setup();
  flat.scale = 0.0;
  EXPECT_THROW(load_procedures(reader, flat), std::invalid_argument);
}

TEST(BoneOfTest, DamagedRowsAreRefused) {
  const auto refused = [](auto&& damage) {
    record::BoneRecord record = test::block_record(0);
    damage(record);
    EXPECT_THROW(bone::bone_of(record), std::invalid_argument);
  };
  refused([](record::BoneRecord& r) { r.bone.size[1] = -3; });
  refused([](record::BoneRecord& r) { r.bone.size = {8000, 8000, 8000}; });
  refused([](record::BoneRecord& r) { r.bone.spacing = 0.0; });
  refused([](record::BoneRecord& r) { r.structures[0].label = 300; });
  refused([](record::BoneRecord& r) { r.runs[0].first = 719; });
  refused([](record::BoneRecord& r) { r.runs[0].label = 9; });
  refused([](record::BoneRecord& r) { r.densities[0].voxel = 720; });
  refused([](record::BoneRecord& r) { r.densities[0].density = 1.5F; });
}

}  // namespace
}  // namespace haptrial::analysis::drilling
