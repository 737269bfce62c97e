#include "core/record/read/trial_progress.h"

#include <gtest/gtest.h>

#include "core/record/write/session_writer.h"
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
  SessionWriter writer(folder / "a.h5", test::example_info());
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
  writer.add_event({1, "skipped", "trial 2"});
  writer.close();
  const TrialProgress progress = trial_progress(SessionReader(folder / "a.h5"));
  EXPECT_EQ(progress.planned, 72);
  EXPECT_EQ(progress.done, 1);
  EXPECT_EQ(progress.skipped, 1);
  EXPECT_EQ(progress.aborted, 1);
}

TEST(TrialProgressTest, AnOldFileDoesNotSayWhatWasPlanned) {
  const SessionReader reader(HAPTRIAL_SOURCE_DIR "/tests/core/record/data/version1.hdf5");
  EXPECT_EQ(trial_progress(reader).planned, std::nullopt);
}

}  // namespace
}  // namespace haptrial::record
