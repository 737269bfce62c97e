#include "analysis/force_training/score/score.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "core/base/error.h"
#include "core/base/parallel.h"

namespace haptrial::analysis {
namespace {

/// Both curves of one recall on their common time base.
struct Prepared {
  TimeBase time;
  std::vector<double> target, target_slope;
  std::vector<double> applied, applied_slope;

  AlignmentPair views() const { return {{target, target_slope}, {applied, applied_slope}}; }
};

/// The alignment takes no larger values (kLargestAlignmentError), and no device makes them.
void check_size(std::span<const double> values, double power, double weight, const char* name) {
  double largest = 0.0;
  for (const double value : values) {
    largest = std::max(largest, std::abs(value));
  }
  if (!(weight * std::pow(largest, power) <= Aligner::kMaxError)) {
    throw InputError(std::string(name) + " reaches " + std::to_string(largest) +
                     "; allowed: at most 1e12 after weighting");
  }
}

Prepared prepare(const SampledCurve& target, const SampledCurve& applied,
                 const ScoreParameters& p) {
  Prepared ready;
  ready.time.duration =
      std::max(duration_of(target, "the target force"), duration_of(applied, "the applied force"));
  ready.time.samples = static_cast<std::size_t>(p.samples);
  ready.target = resample(target, ready.time);
  ready.target_slope = slope(ready.target, ready.time);
  ready.applied = box_filter(resample(applied, ready.time), ready.time, p.filter_width);
  ready.applied_slope = slope(ready.applied, ready.time);
  check_size(ready.target, p.alignment.power, p.alignment.force_weight, "the target force");
  check_size(ready.applied, p.alignment.power, p.alignment.force_weight, "the applied force");
  check_size(ready.target_slope, p.alignment.power, p.alignment.slope_weight,
             "the slope of the target force");
  check_size(ready.applied_slope, p.alignment.power, p.alignment.slope_weight,
             "the slope of the applied force");
  return ready;
}

/// Options with the window in samples of the recall's time base.
AlignmentOptions options_on(const TimeBase& time, const ScoreParameters& p) {
  AlignmentOptions options = p.alignment;
  if (p.window) {
    const double most = static_cast<double>(time.samples);
    const double rounded_up = *p.window / time.step() * (1.0 + 1e-9);  // 0.3 s are 3 steps of 0.1 s
    options.window = static_cast<std::size_t>(std::min(rounded_up, most));
  }
  return options;
}

double rms_difference(std::span<const double> a, std::span<const double> b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    sum += (a[i] - b[i]) * (a[i] - b[i]);
  }
  return std::sqrt(sum / static_cast<double>(a.size()));
}

RecallScore score_of(const Prepared& ready, const Alignment& alignment,
                     std::span<const double> warped, const ScoreParameters& p) {
  RecallScore score;
  score.alignment_cost = alignment.cost / alignment.weight;
  score.rms_force = rms_difference(ready.target, warped);
  // The slopes are warped, not the warped curve's taken: that one is a staircase.
  score.rms_slope = rms_difference(ready.target_slope, warp(ready.applied_slope, alignment.path));
  score.rms_unaligned = rms_difference(ready.target, ready.applied);
  score.score = (p.cost_share * score.alignment_cost + p.force_share * score.rms_force +
                 p.slope_share * score.rms_slope) /
                (p.cost_share + p.force_share + p.slope_share);
  return score;
}

/// Scores one group of recalls with the workspaces of one thread.
class GroupScorer {
 public:
  explicit GroupScorer(const ScoreParameters& parameters) : parameters_(parameters) {}

  void score(std::span<const RecallPair> pairs, std::size_t first, std::span<RecallScore> results) {
    ready_.clear();
    for (std::size_t k = 0; k < pairs.size(); ++k) {
      if (!pairs[k].target || !pairs[k].applied) {
        throw std::invalid_argument("score: a recall needs two curves");
      }
      try {
        ready_.push_back(prepare(view(*pairs[k].target), view(*pairs[k].applied), parameters_));
      } catch (const InputError& error) {
        throw InputError("recall " + std::to_string(first + k) + ": " + error.what());
      }
    }
    align();
    for (std::size_t k = 0; k < pairs.size(); ++k) {
      const auto warped = warp(ready_[k].applied, alignments_[k].path);
      results[k] = score_of(ready_[k], alignments_[k], warped, parameters_);
    }
  }

 private:
  /// Windows differ with the durations, so each pair then goes alone.
  void align() {
    views_.clear();
    for (const Prepared& ready : ready_) {
      views_.push_back(ready.views());
    }
    alignments_.resize(ready_.size());
    if (!parameters_.window) {
      aligner_.align_batch(views_, parameters_.alignment, alignments_);
      return;
    }
    for (std::size_t k = 0; k < ready_.size(); ++k) {
      aligner_.align(views_[k].target, views_[k].applied, options_on(ready_[k].time, parameters_),
                     alignments_[k]);
    }
  }

  const ScoreParameters& parameters_;
  Aligner aligner_;
  std::vector<Prepared> ready_;
  std::vector<AlignmentPair> views_;
  std::vector<Alignment> alignments_;
};

}  // namespace

std::vector<double> warp(std::span<const double> applied, std::span<const PathPoint> path) {
  std::vector<double> warped(path.empty() ? 0 : path.back().target + 1u, 0.0);
  for (std::size_t k = 0; k < path.size();) {
    const std::size_t target = path[k].target;
    double sum = 0.0;
    std::size_t count = 0;
    for (; k < path.size() && path[k].target == target; ++k, ++count) {
      sum += applied[path[k].applied];
    }
    warped[target] = sum / static_cast<double>(count);
  }
  return warped;
}

RecallDetail align_curves(const SampledCurve& target, const SampledCurve& applied,
                          const ScoreParameters& parameters) {
  check(parameters);
  Prepared ready = prepare(target, applied, parameters);
  const AlignmentPair views = ready.views();
  Alignment alignment = align(views.target, views.applied, options_on(ready.time, parameters));
  std::vector<double> warped = warp(ready.applied, alignment.path);
  const RecallScore score = score_of(ready, alignment, warped, parameters);
  return {score,
          ready.time,
          std::move(ready.target),
          std::move(ready.applied),
          std::move(alignment.path),
          std::move(warped)};
}

RecallDetail score_recall_in_detail(const ForceCurve& target, const ForceCurve& applied,
                                    const ScoreParameters& parameters) {
  return align_curves(view(target), view(applied), parameters);
}

RecallScore score_recall(const ForceCurve& target, const ForceCurve& applied,
                         const ScoreParameters& parameters) {
  return score_recall_in_detail(target, applied, parameters).score;
}

std::vector<RecallScore> score_recalls(std::span<const RecallPair> pairs,
                                       const ScoreParameters& parameters, int jobs) {
  check(parameters);
  std::vector<RecallScore> results(pairs.size());
  in_groups(pairs.size(), Aligner().lanes(), jobs, [&] {
    return [&, scorer = GroupScorer(parameters)](std::size_t first, std::size_t count) mutable {
      scorer.score(pairs.subspan(first, count), first, std::span(results).subspan(first, count));
    };
  });
  return results;
}

void fill(TrialScore& trial, const RecallScore& recall) {
  trial.score = recall.score;
  trial.alignment_cost = recall.alignment_cost;
  trial.rms_force = recall.rms_force;
  trial.rms_slope = recall.rms_slope;
  trial.rms_unaligned = recall.rms_unaligned;
}

}  // namespace haptrial::analysis
