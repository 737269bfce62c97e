#include "analysis/force_training/score/score.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "core/base/error.h"
#include "core/base/random.h"

namespace haptrial::analysis {
namespace {

/// A sum of bumps at the given instants, over 12 s.
ForceCurve bumps(const std::vector<double>& instants, double height = 8.0, double rate = 500.0) {
  ForceCurve curve{rate, {}};
  for (double t = 0.0; t <= 12.0 + 0.5 / rate; t += 1.0 / rate) {
    double force = 0.0;
    for (double instant : instants) {
      force += height * std::exp(-std::pow((t - instant) / 0.5, 2));
    }
    curve.force.push_back(force);
  }
  return curve;
}

ForceCurve constant(double force, double duration) {
  return {100.0, std::vector<double>(static_cast<std::size_t>(duration * 100.0) + 1, force)};
}

ScoreParameters unfiltered() {
  ScoreParameters parameters;
  parameters.filter_width = 0.0;
  return parameters;
}

TEST(ScoreTest, PerfectRecallScoresZero) {
  const ForceCurve target = bumps({2.0, 6.0, 9.0});
  EXPECT_EQ(score_recall(target, target, unfiltered()), RecallScore{});
}

TEST(ScoreTest, AnOffsetIsWhatItIs) {
  // Two constants: every pair costs w_f * 3, nothing is gained by warping, and slopes are 0.
  ScoreParameters parameters;
  parameters.alignment.force_weight = 2.0;
  parameters.cost_share = 1.0;
  parameters.force_share = 2.0;
  parameters.slope_share = 5.0;
  const RecallScore score = score_recall(constant(1.0, 5.0), constant(4.0, 5.0), parameters);
  EXPECT_NEAR(score.alignment_cost, 6.0, 1e-9);
  EXPECT_NEAR(score.rms_force, 3.0, 1e-9);
  EXPECT_NEAR(score.rms_slope, 0.0, 1e-9);
  EXPECT_NEAR(score.rms_unaligned, 3.0, 1e-9);
  EXPECT_NEAR(score.score, (6.0 + 2.0 * 3.0) / 8.0, 1e-9);
}

TEST(ScoreTest, EachShareAloneGivesItsPart) {
  const ForceCurve target = bumps({2.0, 6.0, 9.0}), applied = bumps({2.4, 5.8, 9.5}, 6.0);
  ScoreParameters parameters;
  const auto with = [&](double cost, double force, double slope_share) {
    parameters.cost_share = cost;
    parameters.force_share = force;
    parameters.slope_share = slope_share;
    return score_recall(target, applied, parameters);
  };
  const RecallScore all = with(1.0, 2.0, 4.0);
  EXPECT_GT(all.alignment_cost, 0.0);
  EXPECT_GT(all.rms_slope, 0.0);
  EXPECT_DOUBLE_EQ(with(3.0, 0.0, 0.0).score, all.alignment_cost);
  EXPECT_DOUBLE_EQ(with(0.0, 3.0, 0.0).score, all.rms_force);
  EXPECT_DOUBLE_EQ(with(0.0, 0.0, 3.0).score, all.rms_slope);
  EXPECT_DOUBLE_EQ(all.score,
                   (all.alignment_cost + 2.0 * all.rms_force + 4.0 * all.rms_slope) / 7.0);
}

TEST(ScoreTest, AWorseRecallScoresHigher) {
  const ForceCurve target = bumps({2.0, 6.0, 9.0});
  double previous = -1.0;
  for (double height : {8.0, 7.0, 5.0, 2.0, 0.0}) {
    const double score = score_recall(target, bumps({2.2, 5.9, 9.1}, height), {}).score;
    EXPECT_GT(score, previous) << height;
    previous = score;
  }
}

TEST(ScoreTest, OnlyTheAppliedForceIsFiltered) {
  const ForceCurve target = bumps({3.0, 7.0});
  ScoreParameters wide;
  wide.filter_width = 1.0;
  const RecallDetail detail = score_recall_in_detail(target, target, wide);
  const auto raw = resample(target, detail.time);
  EXPECT_EQ(detail.target, raw);
  EXPECT_EQ(detail.applied, box_filter(raw, detail.time, 1.0));
  EXPECT_GT(detail.score.score, 0.0);
}

TEST(ScoreTest, DetailHoldsTogether) {
  const ForceCurve target = bumps({2.0, 6.0, 9.0}), applied = bumps({2.4, 5.8, 9.5});
  const ScoreParameters parameters;
  const RecallDetail detail = score_recall_in_detail(target, applied, parameters);
  EXPECT_EQ(detail.score, score_recall(target, applied, parameters));
  EXPECT_EQ(detail.time.samples, 1000u);
  EXPECT_DOUBLE_EQ(detail.time.duration, 12.0);
  EXPECT_EQ(detail.warped, warp(detail.applied, detail.path));
  double sum = 0.0;
  for (std::size_t i = 0; i < 1000; ++i) {
    sum += std::pow(detail.target[i] - detail.warped[i], 2);
  }
  EXPECT_NEAR(detail.score.rms_force, std::sqrt(sum / 1000.0), 1e-12);
  EXPECT_LT(detail.score.rms_force, 0.2 * detail.score.rms_unaligned);
}

TEST(ScoreTest, WarpTakesTheMeanOfThePairedSamples) {
  const std::vector<double> applied{1.0, 2.0, 6.0, 10.0};
  const std::vector<PathPoint> path{{0, 0}, {1, 1}, {1, 2}, {2, 3}, {3, 3}};
  EXPECT_EQ(warp(applied, path), (std::vector<double>{1.0, 4.0, 10.0, 10.0}));
  EXPECT_TRUE(warp(applied, {}).empty());
}

TEST(ScoreTest, TheTimeBaseLastsAsLongAsTheLongerCurve) {
  const ScoreParameters parameters = unfiltered();
  const auto detail = score_recall_in_detail(constant(2.0, 5.0), constant(2.0, 8.0), parameters);
  EXPECT_DOUBLE_EQ(detail.time.duration, 8.0);
  EXPECT_EQ(detail.score.score, 0.0);
}

std::vector<ForceCurve> random_curves(std::size_t count) {
  RandomStream random(5, "recalls");
  std::vector<ForceCurve> curves;
  for (std::size_t k = 0; k < count; ++k) {
    curves.push_back(
        bumps({random.uniform(1.0, 4.0), random.uniform(4.0, 8.0), random.uniform(8.0, 11.0)},
              random.uniform(3.0, 9.0), 100.0));
  }
  return curves;
}

TEST(ScoreTest, ManyScoresEqualSingleOnesOnAnyNumberOfThreads) {
  const auto curves = random_curves(80);
  std::vector<RecallPair> pairs;
  for (std::size_t k = 0; k + 1 < curves.size(); k += 2) {
    pairs.push_back({&curves[k], &curves[k + 1]});
  }
  ScoreParameters parameters;
  parameters.samples = 301;
  std::vector<RecallScore> single;
  for (const RecallPair& pair : pairs) {
    single.push_back(score_recall(*pair.target, *pair.applied, parameters));
  }
  for (int jobs : {1, 2, 3, 16}) {
    EXPECT_EQ(score_recalls(pairs, parameters, jobs), single) << jobs;
  }
  EXPECT_TRUE(score_recalls({}, parameters, 4).empty());
}

TEST(ScoreTest, TheFirstBadRecallIsNamed) {
  const auto curves = random_curves(2);
  const ForceCurve bad{1000.0, {1.0, std::nan("")}}, empty{1000.0, {}};
  std::vector<RecallPair> pairs(50, {&curves[0], &curves[1]});
  pairs[20].applied = &bad;
  pairs[49].target = &empty;
  for (int jobs : {1, 4}) {
    try {
      score_recalls(pairs, {}, jobs);
      FAIL() << "a bad recall was scored";
    } catch (const InputError& error) {
      EXPECT_STREQ(error.what(),
                   "recall 20: the applied force is nan N at sample 1; allowed: finite forces");
    }
  }
}

TEST(ScoreTest, BadInputIsRefused) {
  const ForceCurve good = constant(1.0, 1.0), huge = constant(1e15, 1.0);
  EXPECT_THROW(score_recall(good, huge, {}), InputError);
  EXPECT_THROW(score_recall({0.0, {1.0, 2.0}}, good, {}), InputError);
  ScoreParameters parameters;
  parameters.samples = 1;
  EXPECT_THROW(score_recall(good, good, parameters), std::invalid_argument);
  const std::vector<RecallPair> one{{&good, &good}}, none{{&good, nullptr}};
  EXPECT_THROW(score_recalls(one, {}, 0), std::invalid_argument);
  EXPECT_THROW(score_recalls(none, {}, 1), std::invalid_argument);
}

TEST(ScoreTest, FillCopiesEveryNumberAndNothingElse) {
  TrialScore trial;
  trial.subject = "s01";
  trial.trial = 7;
  fill(trial, {1.0, 2.0, 3.0, 4.0, 5.0});
  EXPECT_EQ(trial.score, 1.0);
  EXPECT_EQ(trial.alignment_cost, 2.0);
  EXPECT_EQ(trial.rms_force, 3.0);
  EXPECT_EQ(trial.rms_slope, 4.0);
  EXPECT_EQ(trial.rms_unaligned, 5.0);
  EXPECT_EQ(trial.subject, "s01");
  EXPECT_EQ(trial.trial, 7);
}

/// Figure 25: three peaks; a recall with each peak mistimed, not all the same way; and no force.
/// Plain RMS prefers the one who did nothing, the score the one who remembered.
TEST(ScoreTest, Figure25) {
  const ForceCurve black = bumps({2.5, 6.0, 9.5});
  const ForceCurve red = bumps({3.5, 5.0, 10.5});
  const ForceCurve green = bumps({});
  const RecallScore recalled = score_recall(black, red, {});
  const RecallScore idle = score_recall(black, green, {});
  EXPECT_GT(recalled.rms_unaligned, idle.rms_unaligned);
  EXPECT_LT(recalled.score, idle.score);
  EXPECT_LT(recalled.alignment_cost, idle.alignment_cost);
  EXPECT_LT(recalled.rms_force, idle.rms_force);
  EXPECT_LT(recalled.rms_slope, idle.rms_slope);

  // One shift of all time cannot do that: even the best leaves more than the alignment does.
  const auto target = resample(black, {12.0, 1000}), applied = resample(red, {12.0, 1000});
  double best_shifted = std::numeric_limits<double>::infinity();
  for (int shift = -200; shift <= 200; ++shift) {
    double sum = 0.0;
    for (int i = 0; i < 1000; ++i) {
      sum += std::pow(target[i] - applied[std::clamp(i + shift, 0, 999)], 2);
    }
    best_shifted = std::min(best_shifted, std::sqrt(sum / 1000.0));
  }
  EXPECT_LT(recalled.rms_force, 0.5 * best_shifted);
}

}  // namespace
}  // namespace haptrial::analysis
