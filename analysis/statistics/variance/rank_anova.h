#pragma once

#include <cstddef>
#include <vector>

#include "analysis/statistics/base/defined.h"

namespace haptrial::analysis {

/// A test of several groups or conditions on ranks, corrected for ties. Up to kExactRanks
/// participants p is exact, the share of all arrangements of the ranks that are as far out, unless
/// there are too many conditions to look at them (about five); else it is from chi squared.
struct RankAnova {
  double chi_squared{0.0};
  double df{0.0};
  double p{0.0};
  bool exact{false};
};

inline constexpr std::size_t kExactRanks = 12;

/// Kruskal and Wallis' test that no group tends to larger values: one-way analysis of ranks.
/// @param groups  sizes may differ.
/// Undefined with fewer than two groups, an empty group, one value in every group, values that are
/// all equal, or one that is not finite.
/// Source: Kruskal and Wallis 1952, Journal of the American Statistical Association 47.
Defined<RankAnova> kruskal_wallis(const std::vector<std::vector<double>>& groups);

/// Friedman's test that no condition tends to larger values: ranks within each participant.
/// @param table  (participants x conditions).
/// Undefined as repeated_measures_anova, or where every participant's values are all equal.
/// Source: Friedman 1937, Journal of the American Statistical Association 32.
Defined<RankAnova> friedman(const std::vector<std::vector<double>>& table);

}  // namespace haptrial::analysis
