#pragma once

#include <optional>
#include <span>

#include "analysis/statistics/base/defined.h"
#include "analysis/statistics/relation/correlation.h"
#include "analysis/statistics/tests/t_tests.h"

namespace haptrial::analysis {

/// A number that was estimated, with its standard error (0: taken as known).
struct Estimated {
  double value{0.0};
  double error{0.0};
};

/// A number with its standard error and interval.
struct CuePrediction {
  double value{0.0};
  double error{0.0};
  double low{0.0}, high{0.0};
};

/// Two independent cues of one size, weighed by their reliability 1 / σ²:
///
///     w_1 = σ_2² / (σ_1² + σ_2²),  w_2 = 1 - w_1,  1 / σ² = 1 / σ_1² + 1 / σ_2²
///
/// the weights that give the least variance to w_1 s_1 + w_2 s_2.
/// Source: Ernst and Banks 2002, Nature 415, 429.
struct CombinedCues {
  CuePrediction first_weight;
  CuePrediction combined_sd;  // σ, in the unit of σ_1 and σ_2
};

/// Intervals by the delta method on log(w_1 / w_2) and log σ: a weight stays inside (0, 1).
/// @param first_sd, second_sd  standard deviations of one cue alone, > 0, their errors >= 0. Those
/// of a two-interval comparison divided by √2, or not, for both alike.
/// @param level  coverage of the intervals, inside (0, 1).
/// @throws std::invalid_argument naming what breaks its bound.
CombinedCues predict_combination(const Estimated& first_sd, const Estimated& second_sd,
                                 double level = 0.95);

/// A point of subjective equality of a stimulus whose cues disagree.
struct ConflictPse {
  double first{0.0};   // what the first cue of the standard shows
  double second{0.0};  // what the second shows, same unit
  Estimated pse;       // the comparison (without conflict) that seems equal; error > 0
};

/// pse = second + bias + w_1 (first - second), by least squares weighted with 1 / error².
struct ObservedWeight {
  CuePrediction first_weight;  // not held inside (0, 1)
  double bias{0.0};
  double chi_squared{0.0};  // of what is left; its expectation is `df`
  std::size_t df{0};
};

/// Undefined with fewer than two conflicts or when all are the same.
/// @throws std::invalid_argument when an error is not above 0, a value is not finite or the level
/// breaks its bound.
Defined<ObservedWeight> observed_weight(std::span<const ConflictPse> conflicts,
                                        double level = 0.95);

/// One participant's estimates.
struct CueParticipant {
  double first_sd{0.0}, second_sd{0.0};  // of one cue alone, > 0
  double combined_sd{0.0};               // of both cues, > 0
  double first_weight{0.0};              // observed
  /// Predicted; left out: what first_sd and second_sd give.
  std::optional<double> predicted_sd{}, predicted_weight{};
};

/// Observed against predicted, over participants. Standard deviations are compared by their
/// logarithms. One that is predicted from single ones is too low by about w_1 w_2 (ε_1² + ε_2²) of
/// itself when these have the relative errors ε (1 % at 15 %). The better of two estimated cues is
/// better by luck, too: `beats_best` is therefore conservative.
struct CueComparison {
  Defined<TTest> weight;         // observed - predicted, two-sided (paired_t_test)
  Defined<TTest> log_sd;         // log observed - log predicted, two-sided
  Defined<TTest> beats_best;     // log observed < log of the better single cue, one-sided
  Defined<Correlation> weights;  // observed with predicted, Pearson
};

/// @throws std::invalid_argument naming a standard deviation that is not above 0.
CueComparison compare_cues(std::span<const CueParticipant> participants, double level = 0.95);

}  // namespace haptrial::analysis
