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

/// Centre from which a group's deviations are measured.
enum class Centre {
  kMean,    // Levene 1960; for symmetric data
  kMedian,  // Brown and Forsythe 1974; robust where they are skewed
};

/// Levene's test that all groups vary alike: a one-way analysis of variance of the distances of the
/// values from their group's centre.
/// Undefined as one_way_anova, or where all values of a group lie equally far from its centre (two
/// values always do).
/// Source: Levene 1960, in Contributions to Probability and Statistics; Brown and Forsythe 1974,
/// Journal of the American Statistical Association 69.
Defined<Anova> levene(const std::vector<std::vector<double>>& groups, Centre centre);

/// One-way analysis of variance for groups whose variances differ: each group weighs as its size by
/// its variance. Squares and eta squared stay 0: the weighed ones are no shares of a whole.
/// Undefined with fewer than two groups, a group of fewer than two values or without variance, or a
/// value that is not finite.
/// Source: Welch 1951, Biometrika 38; R's oneway.test.
Defined<Anova> welch_anova(const std::vector<std::vector<double>>& groups);

}  // namespace haptrial::analysis
