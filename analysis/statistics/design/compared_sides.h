#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "analysis/statistics/design/analysis_plan.h"
#include "analysis/statistics/design/design_sides.h"
#include "analysis/statistics/design/design_table.h"
#include "analysis/statistics/tests/bootstrap.h"
#include "analysis/statistics/tests/permutation.h"
#include "analysis/statistics/tests/wilcoxon.h"
#include "analysis/statistics/variance/effect_size.h"

namespace haptrial::analysis {

inline constexpr const char* kNotAskedFor = "it was not asked for";

/// Two sides of a design compared: participants' means, paired where the same participants have
/// both, and Welch's test where they are different people.
struct SideTest {
  PlannedTest sides;
  bool paired{true};
  std::size_t count_a{0};  // participants; pairs where paired
  std::size_t count_b{0};
  Defined<TTest> t{Undefined{"nothing was compared"}};
  Defined<double> holm{Undefined{"nothing was compared"}};      // p of t over the family
  Defined<EffectSize> size{Undefined{"nothing was compared"}};  // d_z where paired, else d
  Defined<RankTest> ranks{Undefined{"nothing was compared"}};   // Wilcoxon, or Mann and Whitney
  Defined<double> ranks_holm{Undefined{"nothing was compared"}};
  Defined<PermutationTest> permutation{Undefined{"nothing was resampled"}};
  Defined<double> permutation_holm{Undefined{"nothing was resampled"}};
  Defined<BootstrapInterval> bootstrap{Undefined{"nothing was resampled"}};  // of the difference
  TestsBeside beside;                                     // which of these were asked for
  Defined<double> bayes_factor{Undefined{kNotAskedFor}};  // of an effect against none
  Defined<EquivalenceTest> equivalence{Undefined{kNotAskedFor}};
  Defined<double> equivalence_holm{Undefined{kNotAskedFor}};
  Defined<TTest> trimmed{Undefined{kNotAskedFor}};  // Yuen's
  Defined<double> trimmed_holm{Undefined{kNotAskedFor}};
  std::string covariate{};  // for which `adjusted` is; empty: none
  Defined<TTest> adjusted{Undefined{kNotAskedFor}};
  Defined<double> adjusted_holm{Undefined{kNotAskedFor}};
};

/// "paired t" or "Welch's t".
std::string name_of_test(const SideTest& test);

/// The test of two sides, each with cells; undefined where why_not_comparable() has a reason.
/// @param resampling  of the permutation test and the bootstrap interval; none with a count of 0.
SideTest compared(const DesignTable& table, PlannedTest sides, const Cells& a, const Cells& b,
                  const Resampling& resampling, const TestsBeside& beside = {},
                  const Covariate& covariate = {});

/// How much participants changed from one level of a factor to its other levels, such as from a
/// pre-test to a post-test: the mean of each participant's values under each combination of levels,
/// less the mean under the same combination at the baseline. A comparison of these changes between
/// groups is the interaction of group and factor.
/// @param factor  place among the levels
/// @returns an observation for each participant and combination away from the baseline; none for
/// participants without values at the baseline
std::vector<Observation> changes_from(std::span<const Observation> observations, std::size_t factor,
                                      const std::string& baseline);

}  // namespace haptrial::analysis
