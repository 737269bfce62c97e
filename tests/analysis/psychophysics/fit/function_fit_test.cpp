// Intervals of a function hold no number that it cannot have, and that of a track its estimate.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "analysis/psychophysics/fit/function_fit.h"
#include "analysis/psychophysics/fit/track_estimate.h"
#include "core/psychometric/procedure/staircase.h"
#include "tests/analysis/psychophysics/simulated_trials.h"

namespace haptrial::analysis::trials {
namespace {

using testing::Contains;
using testing::HasSubstr;

/// Right answers of about 33 at each of six levels.
FunctionFit fit_of(const std::array<int, 6>& right) {
  constexpr std::array<double, 6> kLevels{51.0, 53.0, 55.0, 57.0, 60.0, 63.0};
  constexpr std::array<int, 6> kTotals{34, 34, 33, 33, 33, 33};
  AnsweredSeries series;
  series.participant = "P1";
  for (std::size_t i = 0; i < kLevels.size(); ++i) {
    for (int trial = 0; trial < kTotals[i]; ++trial) {
      series.trials.push_back(
          {series.trials.size(), kLevels[i], kLevels[i], trial < right[i] ? 1 : 0, 0, 0, ""});
    }
  }
  TrialsPlan plan;
  plan.kind = AnalysisKind::kPsychometric;
  plan.functions = true;
  plan.bayesian = false;
  plan.resamples = 199;
  plan.reference = 50.0;
  return fit_series(series, plan, 1);
}

TEST(FunctionFitTest, WidenedIntervalsHoldNothingThatCannotBe) {
  for (const auto& right :
       {std::array{23, 16, 21, 23, 32, 32}, std::array{16, 16, 24, 20, 29, 29}}) {
    const FunctionFit fit = fit_of(right);
    ASSERT_TRUE(fit.stated);
    ASSERT_THAT(fit.warnings, Contains(HasSubstr("times as long as chance alone")));
    const FunctionReadings& r = *fit.stated;
    EXPECT_GT(r.slope.low, 0.0) << "the function rises";
    EXPECT_LT(r.slope.low, r.slope.value);
    EXPECT_GT(r.slope.high, r.slope.value);
    EXPECT_GE(r.lapse.low, 0.0);
    EXPECT_LE(r.lapse.high, kMostLapses) << "the fit looked no further";
    EXPECT_GE(r.lapse.high, r.lapse.value);
  }
}

TEST(FunctionFitTest, ALapseRateAfterNoLapsesHasNoInterval) {
  const FunctionFit fit = fit_of({15, 15, 20, 25, 33, 33});
  ASSERT_TRUE(fit.stated);
  EXPECT_NEAR(fit.stated->lapse.value, 0.0, 1e-6);
  EXPECT_TRUE(std::isnan(fit.stated->lapse.low) && std::isnan(fit.stated->lapse.high))
      << "33 of 33 right answers leave room for lapses of some percent";
  EXPECT_GT(fit.stated->slope.low, 0.0);
}

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
