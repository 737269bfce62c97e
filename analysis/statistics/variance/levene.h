#pragma once

#include <vector>

#include "analysis/statistics/variance/anova.h"

namespace haptrial::analysis {

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

}  // namespace haptrial::analysis
