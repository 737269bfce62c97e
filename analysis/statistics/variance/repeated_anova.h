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

}  // namespace haptrial::analysis
