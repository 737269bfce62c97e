#pragma once

#include <vector>

#include "core/psychometric/function/axis.h"

namespace haptrial::psychometric {

/// Sizes of steps from one reversal, or trial, on.
struct StaircaseStep {
  double down{0.0};  // after right answers, > 0 [unit of the axis]
  double up{0.0};    // after wrong answers, > 0 [unit of the axis]
  int from{0};       // in force after so many reversals or trials; the first has 0, rising
};

/// Answers 1 are right: "down" makes the task harder, "up" easier.
struct StaircaseParameters {
  enum class Schedule { kReversals, kTrials };         // what StaircaseStep::from counts
  enum class Counting { kInSequence, kInAll };         // see advance()
  enum class AtBound { kHold, kHoldUncounted, kEnd };  // see advance()
  enum class Estimator { kMeanOfReversals, kMedianOfReversals, kMeanOfLevels };

  Axis axis;          // of the steps and of the mean of the estimate
  double start{0.0};  // low <= start <= high [level]
  double low{0.0};    // bounds of the level, low < high; on a logarithmic axis above its
  double high{1.0};   //   origin [level]
  int down{2};        // right answers to a step down, 1 to 100
  int up{1};          // wrong answers to a step up, 1 to 100
  int first_down{0};  // the same before the first reversal; 0: as after it
  int first_up{0};
  Counting counting{Counting::kInSequence};
  std::vector<StaircaseStep> steps;  // at least one
  Schedule schedule{Schedule::kReversals};
  bool right_raises{false};      // harder is a higher level
  bool step_from_applied{true};  // else from the level that was asked for
  AtBound at_bound{AtBound::kHold};
  int blocked_steps{3};   // in sequence that end it, with AtBound::kEnd; 1 to 1000
  int stop_reversals{0};  // stop at so many reversals; 0: none
  int stop_trials{0};     // stop at so many trials; 0: none; the first of both stops
  Estimator estimator{Estimator::kMeanOfReversals};
  int skip{0};  // reversals (or, of a mean of levels, trials) left out at the start
  int last{0};  // only so many of the last ones; 0: all. Not both skip and last
};

/// @throws std::invalid_argument naming the parameter that breaks its bound.
void check(const StaircaseParameters& parameters);

/// Probability of a right answer at which a rule with up = 1 and constant steps is in balance, if
/// the steps are small: p^n step_down = (1 - p^n) step_up, so
///
///     p = (step_up / (step_up + step_down))^(1/n)
///
/// (García-Pérez 1998, Vision Research 38; Levitt 1971 for equal steps). predict_staircase() tells
/// for steps that are not small.
/// @throws std::invalid_argument unless down >= 1 and both sizes are above 0
double balance_of(int down, const StaircaseStep& step);

/// State of a track; it needs no memory beyond this.
struct StaircaseState {
  double x{0.0};  // the next level [axis]
  int right{0};   // answers since the last step
  int wrong{0};
  int direction{0};  // of the last step: -1 down, +1 up, 0 none yet
  int reversals{0};
  int trials{0};
  int blocked{0};  // steps in sequence that a bound prevented
  bool operator==(const StaircaseState&) const = default;
};

StaircaseState begin(const StaircaseParameters& parameters);

/// One answer. The step goes from `from` [axis]; sizes are those in force after this trial and its
/// reversal, if it is one. A trial is a reversal if its step goes against the last one; the level
/// of the reversal is that of the trial.
///
/// Counting: kInSequence sets the count of right answers to 0 with each wrong one and the other way
/// round; kInAll only with each step. They differ if both down and up exceed 1.
///
/// A step that would leave the bounds ends on the bound. At the bound: kHold stays there and counts
/// the turn away from it as a reversal; kHoldUncounted does not; kEnd ends the track after
/// `blocked_steps` such steps in sequence.
/// @returns whether the trial was a reversal
bool advance(const StaircaseParameters& parameters, StaircaseState& state, bool right, double from);

bool stopped(const StaircaseParameters& parameters, const StaircaseState& state);

}  // namespace haptrial::psychometric
