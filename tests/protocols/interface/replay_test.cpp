// Outcomes of trials as the files of an earlier run have them.

#include "protocols/interface/replay.h"

#include <gtest/gtest.h>

#include <vector>

#include "core/record/rows/trial_facts.h"

namespace haptrial::protocols::replay_test {
namespace {

using record::PassRow;
using record::PassStatus;

PassRow pass_of(int trial, PassStatus status, int attempt = 1) {
  PassRow pass;
  pass.trial = trial;
  pass.condition = "one";
  pass.phase = record::Phase::kTest;
  pass.status = status;
  pass.attempt = attempt;
  return pass;
}

class RecordedOutcomeTest : public testing::Test {
 protected:
  std::optional<Outcome> outcome() const {
    PlannedTrial trial;
    trial.trial = 3;
    trial.condition = "one";
    return recorded_outcome({passes_, {}, skipped_, taken_back_}, trial, record::Phase::kTest);
  }
  std::vector<PassRow> passes_;
  std::vector<record::SkippedRow> skipped_;
  std::vector<record::TakenBackRow> taken_back_;
};

TEST_F(RecordedOutcomeTest, ATrialIsWhatItsLastPassIs) {
  EXPECT_FALSE(outcome());
  passes_.push_back(pass_of(3, PassStatus::kAborted));
  EXPECT_EQ(outcome()->end, TrialEnd::kAborted);
  passes_.push_back(pass_of(3, PassStatus::kCompleted, 2));
  EXPECT_EQ(outcome()->end, TrialEnd::kCompleted);
}

TEST_F(RecordedOutcomeTest, ASkippedTrialIsSkippedUnlessItWasPresentedAllTheSame) {
  skipped_.push_back({});
  skipped_.back().trial = 3;
  passes_.push_back(pass_of(3, PassStatus::kAborted));
  EXPECT_EQ(outcome()->end, TrialEnd::kSkipped);
  passes_.push_back(pass_of(3, PassStatus::kCompleted, 2));
  EXPECT_EQ(outcome()->end, TrialEnd::kCompleted);
  taken_back_.push_back({});
  taken_back_.back().pass = 1;
  EXPECT_EQ(outcome()->end, TrialEnd::kSkipped);
}

}  // namespace
}  // namespace haptrial::protocols::replay_test
