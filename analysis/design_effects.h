#pragma once

#include <vector>

#include "analysis/design_tests.h"

namespace haptrial::analysis {

/// The F tests of a design; design_tests.h says which for what.
std::vector<Defined<EffectTest>> design_effects(const DesignTable& table);

/// Friedman's test of one factor within participants, Kruskal and Wallis' of one between.
Defined<RankAnova> design_ranks(const DesignTable& table);

}  // namespace haptrial::analysis
