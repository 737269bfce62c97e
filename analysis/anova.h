#pragma once

#include <vector>

#include "analysis/defined.h"

namespace haptrial::analysis {

/// One-way analysis of variance.
/// Source: Morris 2006, §4.4.
struct Anova {
  double f{0.0};
  double df_between{0.0};
  double df_within{0.0};
  double squares_between{0.0};
  double squares_within{0.0};
  double p{0.0};
  double eta_squared{0.0};  // squares_between / (squares_between + squares_within)
};

/// @param groups  values of each group; sizes may differ.
/// Undefined with fewer than two groups, an empty group, one value in every group, no variance
/// within the groups, or a value that is not finite.
Defined<Anova> one_way_anova(const std::vector<std::vector<double>>& groups);

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
};

/// @param table  (participants x conditions), usually the means of each participant's trials.
/// Undefined with fewer than two participants or conditions, rows of different lengths, a value
/// that is not finite, or differences between conditions that are the same for every participant.
Defined<RepeatedAnova> repeated_measures_anova(const std::vector<std::vector<double>>& table);

}  // namespace haptrial::analysis
