// Studies of people with known functions: what the analysis finds is what they have.
#include "analysis/psychophysics/study/trials_study.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "analysis/psychophysics/fit/series.h"
#include "analysis/psychophysics/study/magnitudes.h"
#include "core/base/error.h"
#include "core/psychometric/procedure/staircase.h"
#include "tests/analysis/psychophysics/simulated_trials.h"

namespace haptrial::analysis::trials {
namespace {

using test::SimulatedTask;
using test::SimulatedTrials;
using testing::IsEmpty;
using testing::SizeIs;

TrialsResult analyzed(const SimulatedTrials& study, const TrialsPlan& plan) {
  return analyze(test::simulated_trials(study), plan, {}, 2);
}
TrialsResult analyzed(const SimulatedTrials& study) {
  return analyzed(study, test::plan_of(study));
}

const Quantity& of(const TrialsResult& result, const std::string& name) {
  const auto at = std::find_if(result.quantities.begin(), result.quantities.end(),
                               [&](const Quantity& q) { return q.name == name; });
  if (at == result.quantities.end()) {
    throw std::out_of_range(name);
  }
  return *at;
}

TEST(TrialsStudyTest, ThresholdsOfTwoIntervalsAreThoseOfThePeople) {
  SimulatedTrials study;
  study.task = SimulatedTask::kConstant;
  study.participants = 40;
  study.conditions = 1;
  study.trials = 400;
  const TrialsResult result = analyzed(study);
  EXPECT_THAT(result.fits, SizeIs(40));
  const Quantity& q = of(result, "threshold");
  ASSERT_THAT(q.means, SizeIs(1));
  // The mean of 40 people whose standard deviation is 0.16 is within 3 standard errors.
  ASSERT_TRUE(q.means[0]);
  EXPECT_NEAR(q.means[0]->mean, test::kTypicalLogThreshold,
              3.0 * q.means[0]->deviation / std::sqrt(40.0));
  EXPECT_LT(q.means[0]->deviation, 0.3);
  // The Weber fraction is the threshold's difference over the standard.
  const FunctionReadings& r = *result.fits[0].stated;
  EXPECT_NEAR(r.weber.value, (r.threshold.value - 300.0) / 300.0, 1e-9);
  EXPECT_NEAR(r.x.value, std::log(r.threshold.value - 300.0), 1e-9);
  EXPECT_FALSE(q.compared);
}

/// A guide that is as strong as the device allows brings the hand to the start; what is felt then
/// stays below.
TEST(TrialsStudyTest, TheForceLimitIsCountedByStage) {
  SimulatedTrials study;
  study.participants = 2;
  study.trials = 40;
  TrialsData data = test::simulated_trials(study);
  for (std::size_t i = 0; i < data.trials.size(); ++i) {
    data.trials[i].stages = {{"approach", 1, true, true, 10}, {"press", 1, true, i == 0, 10, 10}};
  }
  const TrialsResult result = analyze(std::move(data), test::plan_of(study), {}, 1);
  const auto& limited = result.participants.at(0).at_limit;
  EXPECT_EQ(limited.at("approach"), 1.0);
  EXPECT_NEAR(limited.at("press"), 1.0 / static_cast<double>(result.participants[0].counted),
              1e-12);
  EXPECT_FALSE(result.participants.at(1).at_limit.contains("press"));
}

TEST(TrialsStudyTest, IntervalsHoldTheTruthAndBothFitsAgree) {
  SimulatedTrials study;
  study.task = SimulatedTask::kConstant;
  study.participants = 12;
  study.conditions = 1;
  study.trials = 240;
  study.spread = study.interaction = 0.0;
  TrialsPlan plan = test::plan_of(study);
  plan.bayesian = true;
  plan.resamples = 999;
  const TrialsResult result = analyzed(study, plan);
  int likelihood = 0, bayesian = 0;
  for (const FunctionFit& fit : result.fits) {
    ASSERT_TRUE(fit.stated);
    ASSERT_TRUE(fit.bayesian);
    const Estimated a = fit.stated->x, b = fit.bayesian->x;
    likelihood += a.low <= test::kTypicalLogThreshold && test::kTypicalLogThreshold <= a.high;
    bayesian += b.low <= test::kTypicalLogThreshold && test::kTypicalLogThreshold <= b.high;
    EXPECT_LT(std::abs(a.value - b.value), 0.5 * (b.high - b.low));
    EXPECT_THAT(fit.band, SizeIs(9));
    EXPECT_LE(fit.band.front().level.value, fit.band.back().level.value);
    EXPECT_GT(fit.deviance_p, 0.0);
  }
  // Among 12 intervals of 95 %, 8 or fewer hold the truth once in 400,000 studies.
  EXPECT_GE(likelihood, 9);
  EXPECT_GE(bayesian, 9);
}

TEST(TrialsStudyTest, ADifferenceOfConditionsIsFound) {
  SimulatedTrials study;
  study.task = SimulatedTask::kConstant;
  study.trials = 240;
  study.effect = 0.4;
  TrialsPlan plan = test::plan_of(study);
  plan.plan = parse_analysis_plan({"off < on"}, "", "tests");
  const TrialsResult result = analyzed(study, plan);
  const Quantity& q = of(result, "threshold");
  ASSERT_TRUE(q.compared);
  ASSERT_TRUE(q.tests.effects[0]);
  EXPECT_LT(q.tests.effects[0]->p, 0.05);
  ASSERT_THAT(q.tests.planned.tests, SizeIs(1));
  ASSERT_TRUE(q.tests.planned.tests[0].t);
  // Student's t with 11 degrees of freedom is beyond 4.5 once in a thousand studies.
  const TTest& t = *q.tests.planned.tests[0].t;
  EXPECT_LT(std::abs(t.difference + study.effect), 4.5 * t.error);
}

TEST(TrialsStudyTest, PeopleAreOneInTheMixedModel) {
  SimulatedTrials study;
  study.task = SimulatedTask::kComparison;
  study.trials = 140;
  study.effect = 1.0;  // [N]
  study.spread = 0.5;
  study.interaction = 0.2;
  const TrialsResult result = analyzed(study);
  ASSERT_TRUE(result.population) << result.population.because();
  ASSERT_THAT(result.population->points, SizeIs(2));
  const auto& off = result.population->points[0];
  const auto& on = result.population->points[1];
  ASSERT_TRUE(off.point);
  ASSERT_TRUE(on.point);
  EXPECT_EQ(off.condition, "off");
  EXPECT_LT(std::abs(off.point->point - test::kTypicalPoint), 4.5 * off.point->point_error);
  EXPECT_LT(std::abs(on.point->point - test::kTypicalPoint - study.effect),
            4.5 * on.point->point_error);
  ASSERT_TRUE(result.population->condition_p);
  EXPECT_LT(*result.population->condition_p, 0.05);
  EXPECT_EQ(result.population->condition_df, 11);
  EXPECT_FALSE(analyzed({}).population);  // two intervals have a guess rate
}

TEST(TrialsStudyTest, DriftAndRepetitionAreFoundWhereTheyAre) {
  SimulatedTrials study;
  study.task = SimulatedTask::kComparison;
  study.conditions = 1;
  study.trials = 210;
  study.repetition = 0.3;  // [N], width 3 N
  const TrialsResult repeats = analyzed(study);
  ASSERT_TRUE(repeats.repetition);
  EXPECT_GT(repeats.repetition->low, 0.0);
  EXPECT_LT(std::abs(repeats.drift->t), 4.0);
  study.repetition = 0.0;
  study.drift = -0.01;  // [N] of the point of equality, a trial: "larger" at last
  const TrialsResult drifts = analyzed(study);
  ASSERT_TRUE(drifts.drift);
  EXPECT_GT(drifts.drift->low, 0.0);
}

TEST(TrialsStudyTest, DetectionIsThatOfThePeople) {
  SimulatedTrials study;
  study.task = SimulatedTask::kDetection;
  study.participants = 30;
  study.conditions = 1;
  study.trials = 400;
  const TrialsResult result = analyzed(study);
  const Quantity& q = of(result, "d_prime");
  ASSERT_TRUE(q.means[0]);
  EXPECT_NEAR(q.means[0]->mean, test::kTypicalDPrime,
              3.0 * q.means[0]->deviation / std::sqrt(30.0) + 0.02);
  // Yes from 0.8 on; the middle between both distributions is at d' / 2.
  EXPECT_NEAR(of(result, "criterion").means[0]->mean, 0.8 - 0.5 * test::kTypicalDPrime, 0.06);
  // With equal variances the area is Phi(d' / sqrt 2).
  const double area = 0.5 * std::erfc(-test::kTypicalDPrime / 2.0);
  double binormal = 0.0;
  for (const DetectedCondition& one : result.detected) {
    ASSERT_TRUE(one.binormal) << one.binormal.because();
    EXPECT_THAT(one.ratings.noise, SizeIs(6));
    binormal += one.binormal->area / 30.0;
  }
  EXPECT_NEAR(binormal, area, 0.02);
}

TEST(TrialsStudyTest, CatchTrialsAreNoise) {
  TrialsData data = test::simulated_trials({.task = SimulatedTask::kDetection, .conditions = 1});
  for (StudyTrial& trial : data.trials) {
    if (trial.levels[0].applied == 0.0) {
      trial.levels.clear();
      trial.probe = "catch";
    }
  }
  SimulatedTrials study{.task = SimulatedTask::kDetection, .conditions = 1};
  const auto as_probe = detected(data, test::plan_of(study));
  const auto as_level = detected(test::simulated_trials(study), test::plan_of(study));
  ASSERT_EQ(as_probe.size(), as_level.size());
  for (std::size_t i = 0; i < as_probe.size(); ++i) {
    EXPECT_EQ(as_probe[i].counts.false_alarms, as_level[i].counts.false_alarms);
    EXPECT_EQ(as_probe[i].counts.hits, as_level[i].counts.hits);
  }
}

TEST(TrialsStudyTest, ExponentsAreThoseOfThePeople) {
  SimulatedTrials study;
  study.task = SimulatedTask::kMagnitude;
  study.participants = 20;
  study.trials = 50;
  const TrialsResult result = analyzed(study);
  ASSERT_THAT(result.magnitudes, SizeIs(2));
  for (const MagnitudeCondition& one : result.magnitudes) {
    ASSERT_TRUE(one.law);
    EXPECT_LT(*one.law->low, test::kTypicalExponent);
    EXPECT_GT(*one.law->high, test::kTypicalExponent);
  }
  EXPECT_THAT(of(result, "exponent").table.cells, SizeIs(2));
}

TEST(TrialsStudyTest, WhoAnsweredAtOneLevelTakesNoExponentFromOthers) {
  SimulatedTrials study;
  study.task = SimulatedTask::kMagnitude;
  study.participants = 6;
  study.trials = 50;
  TrialsData data = test::simulated_trials(study);
  const TrialsPlan plan = test::plan_of(study);
  const std::string who = data.sessions.front().participant;
  const double level = level_of(data.trials.front(), plan);
  std::erase_if(data.trials, [&](const StudyTrial& trial) {
    return data.session_of(trial).participant == who && level_of(trial, plan) != level;
  });
  for (const MagnitudeCondition& one : magnitudes(data, plan)) {
    ASSERT_TRUE(one.law) << one.law.because();
    EXPECT_THAT(one.law->exponents, SizeIs(5));
    EXPECT_TRUE(one.one_level.empty() || one.one_level == std::vector{who});
  }
}

TEST(TrialsStudyTest, ATrackIsReplayedAsItRan) {
  SimulatedTrials study;
  study.participants = 1;
  study.conditions = 1;
  const TrialsData data = test::simulated_trials(study);
  psychometric::StaircaseParameters p;
  p.axis = {psychometric::Scale::kLog10, 300.0, "N/m"};
  p.start = 450.0;
  p.low = 302.0;
  p.high = 600.0;
  p.steps = {{0.2, 0.2, 0}, {0.1, 0.1, 1}};
  p.stop_trials = study.trials / 2;
  p.skip = 2;
  const auto tracks = track_estimates(data, [&](const std::string& name) {
    p.start = name.starts_with("track 1") ? 450.0 : 345.0;
    return std::make_unique<psychometric::Staircase>(p);
  });
  ASSERT_THAT(tracks, SizeIs(2));
  for (const TrackEstimate& track : tracks) {
    EXPECT_THAT(track.steps, SizeIs(40));
    ASSERT_THAT(track.estimates, SizeIs(1)) << track.because;
    // The mean of the reversals that are marked, on the axis, but for the first two.
    double sum = 0.0;
    int count = 0;
    for (const TrackStep& step : track.steps) {
      if (step.reversal && ++count > 2) {
        sum += std::log10(step.applied - 300.0);
      }
    }
    ASSERT_GT(count, 4);
    EXPECT_NEAR(track.estimates[0].value, 300.0 + std::pow(10.0, sum / (count - 2)), 1e-6);
  }
}

void expect_same_estimates(const TrialsResult& a, const TrialsResult& b) {
  ASSERT_EQ(a.fits.size(), b.fits.size());
  for (std::size_t i = 0; i < a.fits.size(); ++i) {
    ASSERT_EQ(bool(a.fits[i].stated), bool(b.fits[i].stated));
    if (a.fits[i].stated) {
      EXPECT_EQ(a.fits[i].stated->x.value, b.fits[i].stated->x.value);
      EXPECT_EQ(a.fits[i].stated->width.value, b.fits[i].stated->width.value);
      EXPECT_EQ(a.fits[i].stated->slope.value, b.fits[i].stated->slope.value);
      EXPECT_EQ(a.fits[i].stated->lapse.value, b.fits[i].stated->lapse.value);
      EXPECT_EQ(a.fits[i].stated->x.low, b.fits[i].stated->x.low);
    }
  }
  ASSERT_TRUE(a.drift && b.drift && a.repetition && b.repetition);
  EXPECT_EQ(a.drift->p, b.drift->p);
  EXPECT_EQ(a.repetition->p, b.repetition->p);
}

TEST(TrialsStudyTest, AdaptiveTrialsHaveIntervalsThatHoldTheTruth) {
  SimulatedTrials study;
  study.participants = 12;
  study.conditions = 1;
  study.spread = study.interaction = 0.0;
  psychometric::StaircaseParameters p;
  p.axis = {psychometric::Scale::kLog10, 300.0, "N/m"};
  p.low = 302.0;
  p.high = 600.0;
  p.steps = {{0.2, 0.2, 0}, {0.1, 0.1, 1}};
  p.stop_trials = study.trials / 2;
  p.skip = 2;
  const ProcedureOf begin = [p](const std::string& name) {
    auto own = p;
    own.start = name.starts_with("track 1") ? 450.0 : 345.0;
    return std::make_unique<psychometric::Staircase>(own);
  };
  TrialsPlan plan = test::plan_of(study);
  const TrialsResult result = analyze(test::simulated_trials(study), plan, begin, 2);
  psychometric::PsychometricParameters truth = plan.function;
  truth.threshold = 300.0 + std::exp(test::kTypicalLogThreshold);
  const double aim = psychometric::PsychometricFunction(truth).level_for(std::sqrt(0.5));
  int held = 0, own_held = 0;
  for (const FunctionFit& fit : result.fits) {
    EXPECT_TRUE(fit.adaptive);
    if (fit.stated) {
      const Estimated x = fit.stated->x;
      held += x.low <= test::kTypicalLogThreshold && test::kTypicalLogThreshold <= x.high ? 1 : 0;
      EXPECT_TRUE(std::isfinite(fit.stated->width.high)) << "the prior ends it";
    }
  }
  for (const TrackEstimate& track : result.tracks) {
    ASSERT_TRUE(track.estimates.at(0).interval) << track.no_interval;
    const auto [low, high] = *track.estimates[0].interval;
    own_held += low <= aim && aim <= high ? 1 : 0;
  }
  // Among 12 and 24 intervals of 95 %, 8 and 18 or fewer hold the truth once in 10,000 studies.
  EXPECT_GE(held, 9);
  EXPECT_GE(own_held, 19);
  TrialsPlan bare = plan;
  bare.track_intervals = false;
  expect_same_estimates(result, analyze(test::simulated_trials(study), bare, begin, 2));
  plan.functions = false;
  const TrialsResult without = analyze(test::simulated_trials(study), plan, begin, 2);
  EXPECT_FALSE(without.tracks[0].estimates.at(0).interval);
  EXPECT_EQ(without.tracks[0].no_interval,
            "no function of what the procedure learnt from is fitted");
}

/// A range whose easiest level is too hard: tracks lie at its end.
TEST(TrialsStudyTest, TracksAtTheEndOfTheirRangeTellNoMean) {
  SimulatedTrials study;
  study.participants = 6;
  study.conditions = 1;
  psychometric::StaircaseParameters p;
  p.axis.unit = "N/m";
  p.low = 305.0;
  p.high = 325.0;
  p.start = 320.0;
  p.steps = {{4.0, 4.0, 0}};
  p.stop_trials = study.trials / 2;
  p.skip = 2;
  const ProcedureOf begin = [p](const std::string&) {
    return std::make_unique<psychometric::Staircase>(p);
  };
  TrialsData data = test::simulated_trials(study);
  for (StudyTrial& trial : data.trials) {  // answers at chance: the track goes to its end
    trial.levels[0].applied = trial.levels[0].asked = trial.trial % 7 == 0 ? 321.0 : 325.0;
    trial.levels[0].outcome = trial.trial % 2 == 0 ? 1.0 : 0.0;
  }
  TrialsPlan plan = test::plan_of(study);
  plan.serial = false;
  const TrialsResult result = analyze(data, plan, begin, 1);
  for (const TrackEstimate& track : result.tracks) {
    EXPECT_TRUE(track.ended_at_range()) << track.at_end << " of " << track.steps.size();
    EXPECT_TRUE(track.estimates.empty() || !track.estimates.front().interval);
  }
  for (const Quantity& q : result.quantities) {
    for (const auto& mean : q.means) {
      EXPECT_FALSE(mean) << q.name;
    }
  }
}

TEST(TrialsStudyTest, PracticeAndAbortedTrialsCountNowhere) {
  SimulatedTrials study;
  study.task = SimulatedTask::kConstant;
  study.participants = 2;
  TrialsData data = test::simulated_trials(study);
  const TrialsResult before = analyze(data, test::plan_of(study), {}, 1);
  TrialsData more = data;
  StudyTrial practice = data.trials[0];
  practice.practice = true;
  StudyTrial aborted = data.trials[1];
  aborted.completed = false;
  more.trials.insert(more.trials.begin(), {practice, aborted, practice});
  const TrialsResult after = analyze(more, test::plan_of(study), {}, 1);
  ASSERT_EQ(before.fits.size(), after.fits.size());
  for (std::size_t i = 0; i < before.fits.size(); ++i) {
    EXPECT_EQ(before.fits[i].trials, after.fits[i].trials);
    EXPECT_EQ(before.fits[i].fitted.threshold, after.fits[i].fitted.threshold);
  }
  EXPECT_EQ(after.participants[0].practice, 2u);
  EXPECT_EQ(after.participants[0].aborted, 1u);
}

TEST(TrialsStudyTest, AnswersThatTellNothingAreNotDefined) {
  SimulatedTrials study;
  study.task = SimulatedTask::kConstant;
  study.participants = 2;
  study.conditions = 1;
  TrialsData data = test::simulated_trials(study);
  for (StudyTrial& trial : data.trials) {
    trial.levels[0].outcome = 1.0;  // everything right
  }
  const TrialsResult result = analyze(data, test::plan_of(study), {}, 1);
  EXPECT_FALSE(result.fits[0].stated);
  EXPECT_THAT(of(result, "threshold").means, IsEmpty());
  EXPECT_FALSE(result.drift);
}

TEST(TrialsStudyTest, NothingToAnalyseIsSaid) {
  TrialsData data;
  data.sessions = {{"P01.h5", "P01", "", "simulated", true, false}};
  EXPECT_THROW(analyze(data, {}, {}, 1), InputError);
}

}  // namespace
}  // namespace haptrial::analysis::trials
