#include "core/record/read/session_facts.h"

#include <gtest/gtest.h>

#include <array>

#include "core/record/hdf5/session_writer.h"
#include "tests/core/record/session_fixture.h"

namespace haptrial::record {
namespace {

PassRow pass(int trial, Phase phase, PassStatus status, bool practice = false) {
  PassRow row{trial, "haptic", phase};
  row.status = status;
  row.practice = practice;
  return row;
}

TEST(TrialProgressTest, CountsWhatIsDoneSkippedAndAborted) {
  const test::TemporaryFolder folder;
  SessionWriter writer(folder / "a.h5", test::example_info(), {&table_of<SkippedRow>()});
  writer.set_planned(72);
  writer.note_counts({0, 0, 0});
  for (const PassRow& row : {pass(1, Phase::kTraining, PassStatus::kCompleted, true),
                             pass(1, Phase::kTest, PassStatus::kCompleted, true),
                             pass(1, Phase::kTraining, PassStatus::kCompleted),
                             pass(1, Phase::kTest, PassStatus::kAborted),
                             pass(1, Phase::kTraining, PassStatus::kCompleted),
                             pass(1, Phase::kTest, PassStatus::kCompleted),
                             pass(2, Phase::kTraining, PassStatus::kAborted),
                             pass(3, Phase::kTraining, PassStatus::kCompleted),
                             pass(3, Phase::kTest, PassStatus::kAborted)}) {
    writer.add_pass(row);
  }
  const std::array skipped{SkippedRow{1, 2, false}, SkippedRow{2, 2, false},
                           SkippedRow{3, 1, true}};
  writer.add(Rows(std::span<const SkippedRow>(skipped)));
  writer.close();
  const TrialProgress progress = trial_progress(SessionReader(folder / "a.h5"));
  EXPECT_EQ(progress.planned, 72);
  EXPECT_EQ(progress.done, 1);
  EXPECT_EQ(progress.skipped, 1);
  EXPECT_EQ(progress.aborted, 1);
}

TEST(TrialFactsTest, OldFilesSayThemInTheirEvents) {
  const SessionReader reader(HAPTRIAL_SOURCE_DIR "/tests/core/record/data/version4.hdf5");
  ASSERT_FALSE(reader.has(table_of<DampingRow>()));
  const std::vector<DampingRow> damping = reduced_damping(reader);
  ASSERT_EQ(damping.size(), 1U);
  EXPECT_EQ(damping[0].trial, 1);
  EXPECT_EQ(damping[0].least, 0.052);
  EXPECT_EQ(damping[0].seconds, 1.25);
}

TEST(TrialProgressTest, AnOldFileDoesNotSayWhatWasPlanned) {
  const SessionReader reader(HAPTRIAL_SOURCE_DIR "/tests/core/record/data/version1.hdf5");
  EXPECT_EQ(trial_progress(reader).planned, std::nullopt);
}

}  // namespace
}  // namespace haptrial::record
