#pragma once

#include "core/psychometric/procedure/answer_probability.h"
#include "core/psychometric/procedure/staircase_rule.h"

namespace haptrial::psychometric {

struct StaircasePrediction {
  double mean;              // expected estimate, given that there is one [axis]
  double deviation;         // its standard deviation [axis]
  double bias;              // mean - target [axis]
  double without_estimate;  // probability that there is no reversal to take a mean of
  double trials;            // expected number
  double trials_deviation;
};

/// Exact prediction of a staircase: its track is a Markov chain over level, counts of answers,
/// direction and number of reversals, and the first two moments of the sum of the chosen reversals
/// (or levels) are carried along with the probability of each state, trial by trial, until it
/// stops. Answers are independent of each other, and levels are applied as they are asked for.
///
/// The estimator is a mean: of reversals with any stop, of levels only with a stop by trials alone.
/// Work: trials times states; with steps up and down that have no common measure the levels that
/// can be reached grow with the square of the number of trials. Tracks that have not stopped after
/// 100,000 trials count as stopped.
///
/// @param target  the level that is sought
/// @throws std::invalid_argument naming the parameter that breaks its bound, when the estimator is
///         none of these, or with more than 2,000,000 states at a time
StaircasePrediction predict_staircase(const StaircaseParameters& parameters,
                                      const AnswerProbability& probability, double target);

}  // namespace haptrial::psychometric
