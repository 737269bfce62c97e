#pragma once

#include <optional>
#include <string>
#include <vector>

#include "analysis/statistics/design/design_table.h"
#include "analysis/statistics/variance/effect_size.h"
#include "analysis/statistics/variance/rank_anova.h"

namespace haptrial::analysis {

/// Whether a factor, or two together, make a difference: the F test that the design calls for.
struct EffectTest {
  std::string factor;  // "condition", "group × condition"
  std::string test;    // its name
  double f{0.0};
  double df_effect{0.0};
  double df_error{0.0};
  double p{0.0};  // corrected after Greenhouse and Geisser where `epsilon` is given
  std::optional<double> epsilon;
  Defined<EffectSize> size{Undefined{"nothing was measured"}};  // partial eta squared
};

/// The F tests of a design; design_tests.h says which for what.
std::vector<Defined<EffectTest>> design_effects(const DesignTable& table);

/// Friedman's test of one factor within participants, Kruskal and Wallis' of one between.
Defined<RankAnova> design_ranks(const DesignTable& table);

}  // namespace haptrial::analysis
