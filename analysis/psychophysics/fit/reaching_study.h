#pragma once

#include <string>
#include <vector>

#include "analysis/psychophysics/fit/reach_trials.h"
#include "analysis/psychophysics/fit/reaching_plan.h"
#include "analysis/reaching/exponential_fit.h"
#include "analysis/reaching/learning_curve.h"
#include "analysis/reaching/two_rate.h"
#include "analysis/statistics/base/descriptive.h"

namespace haptrial::analysis::trials {

/// A block of all participants in one of their sessions. The blocks of a session follow each other
/// in the order of the first participant, each from a cycle of its own, so that cycles of
/// participants with another order still agree.
struct ReachBlock {
  std::string name;            // of several sessions "session 2, adaptation"
  int session{1};              // of a participant
  std::string in_session;      // its name there: "adaptation"
  std::size_t trials{0};       // of a participant, at most
  std::size_t first_cycle{0};  // of the axis of all blocks
  std::size_t cycles{0};
  double perturbation{0.0};  // mean of its plain reaches: 1 in the field
  bool learns{false};        // the perturbation is not that of the block before, or a session
                             // begins in a field
  Defined<LearningFit> fit{Undefined{"the field is that of the block before"}};
};

/// Curves over the cycles of all blocks; a value is the participant's mean of the cycle.
struct ReachCurve {
  CycleTable table;  // (participants x cycles)
  std::vector<CyclePoint> points;
  std::size_t reaches{0};  // with a value
};

/// One comparison of cycles over participants.
struct ReachContrast {
  std::string name;  // "adaptation: first cycle against its last"
  std::string unit;  // of the difference: "m"; empty: a pure number
  Defined<CycleContrast> contrast{Undefined{"nothing was compared"}};
  Defined<double> holm{Undefined{"nothing was compared"}};  // p over all contrasts
};

/// Means over participants of a block's plain reaches, turned so that the field pushes towards +.
struct BlockMeans {
  Mean movement_time;    // [s]
  Mean peak_speed;       // [m/s]
  Mean error;            // largest [m]
  Mean error_at_150_ms;  // [m]
  Mean direction;        // at 150 ms [rad]
  Mean area;             // [m²]
  Mean compensation;
};

/// How reaches of a participant went wrong.
struct ReachQuality {
  std::string participant;
  std::size_t reaches{0};
  std::size_t not_recorded{0};
  std::size_t no_onset{0};  // or moving at the start
  std::size_t anticipated{0};
  std::size_t never_slowed{0};
  std::size_t not_arrived{0};
  std::size_t missed_target{0};
  std::size_t saturated{0};
};

struct ReachingResult {
  ReachingPlan plan;
  std::vector<StudyReach> reaches;
  std::vector<std::string> participants;  // by the numbers in tables
  std::vector<std::size_t> persons;       // (reaches) such a number
  std::vector<std::size_t> block_of;      // (reaches) in `blocks`
  std::vector<ReachBlock> blocks;
  std::vector<BlockMeans> means;  // (blocks)
  ReachCurve plain, catches;      // error, turned [m]
  ReachCurve clamps;              // force compensation
  std::vector<ReachContrast> contrasts;
  Defined<TwoRateLearning> two_rate{Undefined{"nothing was fitted"}};
  double two_rate_unit{0.0};          // at 150 ms, of one perturbation in the first cycle [m]
  std::vector<ReachQuality> quality;  // by participant

  /// The error of a reach that learning is about, turned [m].
  std::optional<double> error(const StudyReach& reach) const;
};

/// Curves, fits and contrasts of a study's reaches (docs/algorithms/reaching.md). Contrasts are
/// two-sided, their p is adjusted by Holm's method over all of them.
/// @throws InputError when no trial has a reach.
ReachingResult reaching_study(const TrialsData& data, std::vector<StudyReach> reaches,
                              const ReachingPlan& plan, int threads);

}  // namespace haptrial::analysis::trials
