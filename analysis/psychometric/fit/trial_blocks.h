#pragma once

#include <limits>
#include <span>
#include <vector>

#include "core/psychometric/function/psychometric_function.h"

namespace haptrial::analysis {

/// The level of catch trials: nothing is presented, and every "yes" is a guess (S = 0, whether the
/// function rises or falls).
inline constexpr double kNoStimulus = -std::numeric_limits<double>::infinity();

/// The answers to one level.
struct TrialBlock {
  double level{0.0};  // in the unit of the stimulus, or kNoStimulus
  int correct{0};     // 0 <= correct <= total; in yes/no tasks: "yes"
  int total{0};       // > 0
};

/// A level in nine digits: reports take levels that differ less for one.
double nine_digits(double level);

/// Blocks of the same level as one, in the order of the levels.
/// @throws std::invalid_argument naming what breaks its bound, or "blocks" when there are none.
std::vector<TrialBlock> pooled(std::span<const TrialBlock> blocks);

/// The probability of an answer 1 in a block.
double probability_of(const psychometric::PsychometricFunction& function, const TrialBlock& block);

/// Levels on the axis, kNoStimulus as it is. @throws std::invalid_argument when one does not exist
/// there.
std::vector<double> coordinates(const psychometric::Axis& axis, std::span<const TrialBlock> blocks);

/// 2 (log-likelihood of the shares themselves - that of the function), binomial, with its part of
/// each block as a residual with the sign of (observed - predicted).
struct PsychometricDeviance {
  double deviance{0.0};
  std::vector<double> residuals;  // sum of squares: deviance
};
PsychometricDeviance deviance_of(const psychometric::PsychometricFunction& function,
                                 std::span<const TrialBlock> blocks);

}  // namespace haptrial::analysis
