// Which trial a participant means who says that an answer was a mistake.

#include "experiments/runner/reported_mistakes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace haptrial::experiments {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

record::PassRow pass_of(std::int32_t trial, bool practice = false) {
  record::PassRow pass;
  pass.trial = trial;
  pass.practice = practice;
  return pass;
}

class ReportedMistakesTest : public testing::Test {
 protected:
  std::vector<std::string> reported_;
  ReportedMistakes mistakes_{[this](const std::string& trial) { reported_.push_back(trial); }};
};

TEST_F(ReportedMistakesTest, APressAfterTheAnswerIsAboutThePresentTrial) {
  mistakes_.close_pass(pass_of(4), 1000);
  mistakes_.press(2500);  // while its feedback is shown
  mistakes_.close_pass(pass_of(5), 2400);
  EXPECT_THAT(reported_, ElementsAre("trial 5"));
}

TEST_F(ReportedMistakesTest, APressBeforeTheAnswerIsAboutTheTrialBefore) {
  mistakes_.close_pass(pass_of(2, true), 1000);
  mistakes_.press(2300);
  mistakes_.close_pass(pass_of(1), 2400);
  EXPECT_THAT(reported_, ElementsAre("practice trial 2"));
}

TEST_F(ReportedMistakesTest, AnAbortedTrialIsNotMeant) {
  mistakes_.close_pass(pass_of(4), 1000);
  mistakes_.press(2300);
  mistakes_.close_pass(pass_of(5), std::nullopt);
  EXPECT_THAT(reported_, ElementsAre("trial 4"));
}

TEST_F(ReportedMistakesTest, ATrialIsReportedOnceAndInABreakAtOnce) {
  mistakes_.see_to(pass_of(0));
  mistakes_.press(10);
  mistakes_.see_to(pass_of(0));
  EXPECT_THAT(reported_, IsEmpty()) << "nothing was presented yet";
  mistakes_.close_pass(pass_of(1), 1000);
  for (int i = 0; i < 2; ++i) {
    mistakes_.press(2000);
    mistakes_.see_to(pass_of(1));
  }
  EXPECT_THAT(reported_, ElementsAre("trial 1"));
}

TEST_F(ReportedMistakesTest, WhereNothingIsAskedItIsThePresentTrial) {
  mistakes_.press(500);
  mistakes_.close_pass(pass_of(3), std::nullopt);
  EXPECT_THAT(reported_, ElementsAre("trial 3"));
}

}  // namespace
}  // namespace haptrial::experiments
