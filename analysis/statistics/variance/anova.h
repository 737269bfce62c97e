#pragma once

#include <vector>

#include "analysis/statistics/base/defined.h"

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

}  // namespace haptrial::analysis
