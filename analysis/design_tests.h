#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "analysis/analysis_plan.h"
#include "analysis/bootstrap.h"
#include "analysis/design_table.h"
#include "analysis/effect_size.h"
#include "analysis/permutation_test.h"
#include "analysis/rank_anova.h"
#include "analysis/wilcoxon.h"

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
};

/// With fewer participants bootstrap intervals are too narrow (docs/algorithms/statistics.md), and
/// reports do not print them.
inline constexpr std::size_t kFewestForBootstrap = 30;

/// Tests whose p values are adjusted together.
struct TestFamily {
  std::string name;  // "planned", "every two levels of condition"
  std::vector<SideTest> tests;
};

/// What a study's design calls for, with participants as the unit.
struct DesignTests {
  std::string design;                   // in words: "one factor within participants: condition"
  std::vector<std::string> incomplete;  // subjects without a value in each of their cells
  std::vector<Defined<EffectTest>> effects;
  Defined<RankAnova> ranks{Undefined{"it is for one factor"}};  // Friedman, or Kruskal and Wallis
  TestFamily planned;
  std::vector<TestFamily> families;  // without a hypothesis: two-tailed
};

/// @param resampling  of the permutation tests and bootstrap intervals; none with a count of 0.
/// A planned test of a condition without trials is not defined.
///
/// | factors | effects |
/// | one within | repeated-measures analysis of variance, Greenhouse and Geisser's correction |
/// | one between | Welch's analysis of variance |
/// | two within | two-way repeated measures |
/// | one within, one between | mixed analysis of variance, marginal squares (type III) |
/// | two between | two-way analysis of variance, marginal squares (type III) |
/// | more, or combinations that nobody had | none: cells are compared two by two |
DesignTests design_tests(const DesignTable& table, const AnalysisPlan& plan,
                         const Resampling& resampling);

/// @throws InputError where a plan names what the table does not have, or compares trials with
/// themselves.
void check_plan(const DesignTable& table, const AnalysisPlan& plan);

/// "paired t" or "Welch's t".
std::string name_of_test(const SideTest& test);

}  // namespace haptrial::analysis
