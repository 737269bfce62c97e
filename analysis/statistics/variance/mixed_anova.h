#pragma once

#include <cstddef>
#include <vector>

#include "analysis/statistics/variance/anova.h"
#include "analysis/statistics/variance/within_effect.h"

namespace haptrial::analysis {

/// How the condition's squares weigh groups of different size; of no matter with equal groups, and
/// for the group and the interaction in any case.
enum class Squares {
  kSequential,  // by their participants: types I and II, R's aov
  kMarginal,    // alike: type III, SPSS
};

/// Analysis of variance with one factor between participants (the group) and one within (the
/// condition).
struct MixedAnova {
  std::size_t participants{0};
  std::size_t groups{0};
  std::size_t conditions{0};
  /// The analysis of the participants' means; squares are of all values, as aov prints them.
  Defined<Anova> group{Undefined{"nothing was measured"}};
  Defined<WithinEffect> condition{Undefined{"nothing was measured"}};
  Defined<WithinEffect> interaction{Undefined{"nothing was measured"}};
};

/// @param groups  of tables (participants x conditions); numbers of participants may differ.
/// Undefined with fewer than two groups, a group without participants, one participant in every
/// group, or as repeated_measures_anova. An effect whose error does not vary is not defined by
/// itself.
Defined<MixedAnova> mixed_anova(const std::vector<std::vector<std::vector<double>>>& groups,
                                Squares squares = Squares::kSequential);

}  // namespace haptrial::analysis
