#pragma once

#include <cstddef>
#include <vector>

#include "analysis/statistics/variance/within_effect.h"

namespace haptrial::analysis {

/// Values of participants in a design with factors within and between them.
struct MultifactorTable {
  std::vector<std::size_t> within;   // levels of each factor within participants
  std::vector<std::size_t> between;  // levels of each factor between participants
  within::Table values;              // (participants x cells within), the last factor runs fastest
  std::vector<std::vector<std::size_t>> groups;  // (participants x factors between) levels
};

/// The test of some factors together.
struct MultifactorEffect {
  std::vector<std::size_t> within, between;  // the factors, in their order
  Defined<WithinEffect> test{Undefined{"nothing was measured"}};
};

/// Analysis of variance of every factor and every combination of factors, with marginal squares
/// (type III): groups weigh alike. Each effect is held against the variation of its own contrasts
/// between participants of a group; one between participants against that of their means, where
/// sphericity says nothing.
/// @returns single factors first, and of these the ones between participants; each undefined if its
/// error does not vary, and all if a value is not finite, if the participants are no more than the
/// groups, or if some combination of groups has no participant
/// Source: weighted squares of means (Yates 1934); Searle 1971, Linear Models; Maxwell and Delaney
/// 2004, chapters 12 to 14.
std::vector<MultifactorEffect> multifactor_anova(const MultifactorTable& table);

}  // namespace haptrial::analysis
