#pragma once

#include <cstddef>
#include <vector>

#include "analysis/statistics/variance/anova.h"

namespace haptrial::analysis {

/// Two-way analysis of variance with both factors between participants.
struct TwoWayAnova {
  Defined<Anova> a{Undefined{"nothing was measured"}};
  Defined<Anova> b{Undefined{"nothing was measured"}};
  Defined<Anova> interaction{Undefined{"nothing was measured"}};
};

/// Marginal squares (type III): levels weigh alike however many participants they have. df_between
/// and squares_between are those of the effect; eta_squared is the partial one.
/// @param cells     values of each, levels of b running fastest; numbers may differ.
/// @param levels_a  divides the number of cells.
/// Undefined with fewer than two levels of a factor, an empty cell, one value in every cell, no
/// variance within the cells, or a value that is not finite.
/// @throws std::invalid_argument when levels_a does not divide the number of cells.
/// Source: Searle 1971, Linear Models; weighted squares of means (Yates 1934).
Defined<TwoWayAnova> two_way_anova(const std::vector<std::vector<double>>& cells,
                                   std::size_t levels_a);

}  // namespace haptrial::analysis
