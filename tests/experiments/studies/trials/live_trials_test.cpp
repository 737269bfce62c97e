// What the console says while trials run: a trial counts as it was answered the last time.

#include "experiments/studies/trials/live_trials.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <span>

#include "core/record/trials/trial_rows.h"

namespace haptrial::experiments::live_trials_test {
namespace {

using testing::HasSubstr;

class LiveTrialsTest : public testing::Test {
 protected:
  /// A pass with its answer; `again`: the answer was out of time.
  void present(int trial, bool right, bool again = false, bool practice = false) {
    record::PassRow pass;
    pass.trial = trial;
    pass.practice = practice;
    live_.begin_pass(pass, row_);
    record::ResponseRow answer;
    answer.pass = row_;
    answer.trial = trial;
    answer.text = "yes";
    answer.correct = right ? 1 : 0;
    live_.rows(record::Rows(std::span<const record::ResponseRow>(&answer, 1)));
    if (again) {
      record::OutOfTimeRow late;
      late.pass = row_;
      late.again = true;
      live_.rows(record::Rows(std::span<const record::OutOfTimeRow>(&late, 1)));
    }
    live_.end_pass(pass);
    ++row_;
  }
  std::string line() const { return live_.now()->line; }

  LiveTrials live_{"N", {}};
  std::int32_t row_{0};
};

TEST_F(LiveTrialsTest, ATrialThatIsRepeatedCountsOnce) {
  present(1, true);
  EXPECT_THAT(line(), HasSubstr("right so far 1 of 1 (100 %)"));
  present(1, false);  // the experimenter repeated it
  EXPECT_THAT(line(), HasSubstr("right so far 0 of 1 (0 %)"));
  present(2, true, true);  // comes again as another trial
  EXPECT_THAT(line(), HasSubstr("right so far 0 of 1 (0 %)"));
  present(3, true);
  present(4, true);
  EXPECT_THAT(line(), HasSubstr("right so far 2 of 3 (67 %)"));
}

TEST_F(LiveTrialsTest, PracticeDoesNotCount) {
  present(1, true, false, true);
  EXPECT_THAT(line(), testing::Not(HasSubstr("right so far")));
}

}  // namespace
}  // namespace haptrial::experiments::live_trials_test
