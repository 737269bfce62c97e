// The console shows trials while they run.

#include "protocols/psychophysics/live_trials.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/psychometric/procedure/staircase.h"

namespace haptrial::protocols::live_trials_test {
namespace {

using testing::HasSubstr;

class LiveTrialsTest : public testing::Test {
 protected:
  LiveTrialsTest() {
    track_.name = "weber";
    track_.variable = "level";
    track_.unit = "N/m";
    psychometric::StaircaseParameters staircase;
    staircase.start = 500.0;
    staircase.high = 600.0;
    staircase.steps = {{40.0, 40.0}};
    staircase.stop_trials = 40;
    running_.push_back(
        {&track_, "weber", {}, std::make_unique<psychometric::Staircase>(staircase)});
  }
  void present(int trial, double level, int correct, bool practice = false) {
    NextTrial next;
    next.plan.trial = trial;
    next.plan.condition = "0.30000000000000004";
    next.plan.practice = practice;
    next.track = practice ? -1 : 0;
    next.applied = {level};
    live_.begin(next, running_);
    Outcome outcome{next.plan, TrialEnd::kCompleted, {{}}};
    outcome.responses.front().correct = correct;
    outcome.responses.front().reaction_time = 0.84;
    live_.conclude(outcome);
  }
  std::string figure(const std::string& name) const {
    const record::LiveState state = *live_.state();
    for (const record::LiveState::Figure& each : state.figures) {
      if (each.name.starts_with(name)) {
        return each.value;
      }
    }
    return "none";
  }

  Track track_;
  std::vector<RunningTrack> running_;
  LiveTrials live_;
};

TEST_F(LiveTrialsTest, ShowsTheLevelTheSharesAndTheTrackOfThePresentTrial) {
  EXPECT_FALSE(live_.state().has_value());
  present(1, 500.0, 1);
  present(2, 460.0, 0);
  present(3, 500.0, 1);
  EXPECT_EQ(live_.state()->title, "Trial 3");
  EXPECT_EQ(figure("Condition"), "0.3");
  EXPECT_EQ(figure("Level now, level"), "500 N/m");
  EXPECT_EQ(figure("Correct, 0.3"), "2 of 3 (67 %)");
  EXPECT_EQ(figure("Last answers"), "✓ 0.84 s, ✗ 0.84 s, ✓ 0.84 s");
  EXPECT_EQ(figure("Reversals"), "0");
  using Point = record::LiveState::TrackPoint;
  EXPECT_EQ(live_.state()->track, (std::vector<Point>{{500.0, 1}, {460.0, 0}, {500.0, 1}}));
  EXPECT_THAT(live_.state()->line, HasSubstr("Level now, level 500 N/m"));
}

TEST_F(LiveTrialsTest, PracticeIsCountedApartAndAnAbortedTrialIsNotCounted) {
  present(1, 500.0, 1, true);
  EXPECT_EQ(live_.state()->title, "Practice trial 1");
  EXPECT_EQ(figure("Correct, practice"), "1 of 1 (100 %)");
  EXPECT_EQ(figure("Level now"), "none");
  present(1, 500.0, 0);
  live_.conclude({{}, TrialEnd::kAborted, {{}}});
  EXPECT_EQ(figure("Correct, 0.3"), "0 of 1 (0 %)");
  EXPECT_EQ(live_.state()->track.size(), 1u);
}

}  // namespace
}  // namespace haptrial::protocols::live_trials_test
