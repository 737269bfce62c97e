#pragma once

#include <vector>

#include "analysis/statistics/variance/anova.h"

namespace haptrial::analysis {

/// One-way analysis of variance for groups whose variances differ: each group weighs as its size by
/// its variance. Squares and eta squared stay 0: the weighed ones are no shares of a whole.
/// Undefined with fewer than two groups, a group of fewer than two values or without variance, or a
/// value that is not finite.
/// Source: Welch 1951, Biometrika 38; R's oneway.test.
Defined<Anova> welch_anova(const std::vector<std::vector<double>>& groups);

}  // namespace haptrial::analysis
