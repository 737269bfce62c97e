#include "analysis/psychophysics/fit/track_estimate.h"

#include <gtest/gtest.h>

#include "core/psychometric/procedure/staircase.h"
#include "tests/analysis/psychophysics/simulated_trials.h"

namespace haptrial::analysis::trials {
namespace {

/// A series of the method of limits: levels fall until an answer changes, and the estimate is the
/// middle of the last two. An early lapse can only end it above the threshold, so that errors of
/// simulated series lie on one side.
TEST(TrackEstimateTest, AnIntervalDoesNotLeaveOutItsEstimate) {
  test::SimulatedTrials study;
  study.participants = 1;
  study.conditions = 1;
  study.trials = 44;
  psychometric::StaircaseParameters p;
  p.axis.unit = "N/m";
  p.low = 301.0;
  p.high = 600.0;
  p.start = 342.0;
  p.steps = {{2.0, 2.0, 0}};
  p.stop_reversals = 1;
  p.stop_trials = 30;
  p.estimator = psychometric::StaircaseParameters::Estimator::kMeanOfLevels;
  p.last = 2;
  const ProcedureOf begin = [p](const std::string&) {
    return std::make_unique<psychometric::Staircase>(p);
  };
  TrialsData data = test::simulated_trials(study);
  std::map<std::string, int> presented;
  for (StudyTrial& trial : data.trials) {
    GivenLevel& level = trial.levels[0];
    const int before = presented[level.track]++;
    level.applied = level.asked = std::max(342.0 - 2.0 * before, 301.0);
    level.outcome = before < 21 ? 1.0 : 0.0;
  }
  std::vector<TrackEstimate> tracks = track_estimates(data, begin);
  add_track_intervals(tracks, test::plan_of(study), begin, 1);
  ASSERT_EQ(tracks.size(), 2u);
  for (const TrackEstimate& track : tracks) {
    ASSERT_FALSE(track.estimates.empty()) << track.because;
    EXPECT_FALSE(track.ended_at_range());
    EXPECT_FALSE(track.estimates.front().interval);
    EXPECT_EQ(track.no_interval, "nearly all simulated tracks miss the level on the same side");
  }
}

}  // namespace
}  // namespace haptrial::analysis::trials
