#pragma once

#include <span>
#include <vector>

#include "analysis/alignment/alignment.h"
#include "analysis/force_training/score/resample.h"
#include "analysis/force_training/score/score_parameters.h"
#include "analysis/force_training/score/trial_score.h"

namespace haptrial::analysis {

/// How well one force pattern was recalled; the fields mean what they mean in TrialScore.
struct RecallScore {
  double score{0.0};
  double alignment_cost{0.0};  // per pair of the path, each counted by its weight
  double rms_force{0.0};       // [N]
  double rms_slope{0.0};       // [N/s]
  double rms_unaligned{0.0};   // [N]
  bool operator==(const RecallScore&) const = default;
};

/// A score with what it came from, enough to draw Figures 26 and 27.
struct RecallDetail {
  RecallScore score;
  TimeBase time;
  std::vector<double> target;   // resampled (samples) [N]
  std::vector<double> applied;  // resampled, then filtered (samples) [N]
  std::vector<PathPoint> path;
  std::vector<double> warped;  // applied on the target's time base (samples) [N]
};

struct RecallPair {
  const ForceCurve* target{nullptr};
  const ForceCurve* applied{nullptr};
};

/// The applied curve on the target's time base: at each target sample the mean of the applied
/// samples that the path pairs with it.
/// @returns as many values as the path has target samples.
std::vector<double> warp(std::span<const double> applied, std::span<const PathPoint> path);

/// Scores one recall: both curves are resampled onto one time base, which lasts as long as the
/// longer of them (the shorter holds its last force); the applied force goes through the box
/// filter; slopes are taken; the curves are aligned; the applied force is warped onto the target's
/// time base, and its slope likewise (not taken anew: the warped curve is a staircase). The score
/// is the weighted average that ScoreParameters describes; 0 is perfect recall. rms_unaligned
/// compares the same two curves before the alignment. Source: Morris 2006, §4.3.
/// @throws InputError for a curve that duration_of() or the alignment refuses;
///   std::invalid_argument for parameters out of bounds.
RecallScore score_recall(const ForceCurve& target, const ForceCurve& applied,
                         const ScoreParameters& parameters);
RecallDetail score_recall_in_detail(const ForceCurve& target, const ForceCurve& applied,
                                    const ScoreParameters& parameters);

/// Anybody's two curves, at rates or times of their own, each counted from its first sample: the
/// same function with everything it found, in the unit of the values where these are not newtons.
RecallDetail align_curves(const SampledCurve& target, const SampledCurve& applied,
                          const ScoreParameters& parameters);

/// The same for many, side by side in vector lanes and over `jobs` threads. The results do not
/// depend on `jobs`, bit for bit.
/// @throws as score_recall(), for the first pair in the list that is refused, with its index.
std::vector<RecallScore> score_recalls(std::span<const RecallPair> pairs,
                                       const ScoreParameters& parameters, int jobs);

/// Copies a recall's numbers into the record of its trial.
void fill(TrialScore& trial, const RecallScore& recall);

}  // namespace haptrial::analysis
