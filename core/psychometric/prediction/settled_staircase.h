#pragma once

#include <cstddef>

#include "core/psychometric/prediction/answer_probability.h"
#include "core/psychometric/procedure/staircase_rule.h"

namespace haptrial::psychometric {

struct SettledStaircase {
  double mean_level;     // mean over trials [axis]
  double mean_reversal;  // mean over reversals [axis]
  double trials_a_reversal;
  std::size_t states;
};

/// Where a staircase settles that never stops, with its last size of steps: the stationary
/// distribution of the same chain. Levels closer than 1e-9 of the range are one level, so steps
/// that have no common measure have too many; state them as multiples of a common one. Let the
/// bounds be such multiples away from the start too: otherwise a track that touches a bound goes on
/// among other levels, and it takes very long until that has settled.
/// @throws std::invalid_argument naming the parameter that breaks its bound, or with more than
///         200,000 states, or when it has not settled after 1,000,000 rounds
SettledStaircase settle(const StaircaseParameters& parameters,
                        const AnswerProbability& probability);

}  // namespace haptrial::psychometric
