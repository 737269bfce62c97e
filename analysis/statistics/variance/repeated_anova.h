#pragma once

#include <cstddef>
#include <vector>

#include "analysis/statistics/variance/within_effect.h"

namespace haptrial::analysis {

/// One-way analysis of variance with the condition within participants.
struct RepeatedAnova {
  std::size_t participants{0};
  std::size_t conditions{0};
  double f{0.0};
  double df_condition{0.0};
  double df_error{0.0};
  double squares_condition{0.0};
  double squares_participants{0.0};
  double squares_error{0.0};
  double p{0.0};
  double epsilon{1.0};      // Greenhouse and Geisser 1959; 1 / (conditions - 1) .. 1
  double p_corrected{0.0};  // both degrees of freedom times epsilon
  double partial_eta_squared{0.0};
  Sphericity sphericity{};  // Mauchly's test, both factors
  Defined<double> p_huynh_feldt{Undefined{"nothing was measured"}};
};

/// @param table  (participants x conditions), usually the means of each participant's trials.
/// Undefined with fewer than two participants or conditions, rows of different lengths, a value
/// that is not finite, or differences between conditions that are the same for every participant.
Defined<RepeatedAnova> repeated_measures_anova(const std::vector<std::vector<double>>& table);

/// Two-way analysis of variance with both factors within participants. Each effect has its own
/// error, its interaction with participants, and its own sphericity.
struct TwoWayRepeatedAnova {
  std::size_t participants{0};
  std::size_t levels_a{0};
  std::size_t levels_b{0};
  Defined<WithinEffect> a{Undefined{"nothing was measured"}};
  Defined<WithinEffect> b{Undefined{"nothing was measured"}};
  Defined<WithinEffect> interaction{Undefined{"nothing was measured"}};
};

/// @param table     (participants x levels_a * levels_b), levels of b running fastest.
/// @param levels_a  divides the length of a row.
/// Undefined as for one factor, or with fewer than two levels of a factor. An effect that differs
/// by the same amount for every participant is not defined by itself.
/// @throws std::invalid_argument when levels_a does not divide the length of the first row.
Defined<TwoWayRepeatedAnova> two_way_repeated_measures_anova(
    const std::vector<std::vector<double>>& table, std::size_t levels_a);

}  // namespace haptrial::analysis
