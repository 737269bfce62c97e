#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "analysis/statistics/design/analysis_plan.h"
#include "analysis/statistics/design/compared_sides.h"
#include "analysis/statistics/design/design_effects.h"
#include "analysis/statistics/design/design_table.h"
#include "analysis/statistics/design/sequential_looks.h"

namespace haptrial::analysis {

/// Number of participants below which bootstrap intervals are too narrow
/// (docs/algorithms/statistics.md), and reports do not print them.
inline constexpr std::size_t kFewestForBootstrap = 30;

/// Tests whose p values are adjusted together.
struct TestFamily {
  std::string name;  // "planned", "every two levels of condition"
  std::vector<SideTest> tests;
};

/// Holm's p values of a family's tests, each kind of test by itself.
void adjust(TestFamily& family);

/// A test by the name under which simulated studies count it.
struct NamedTest {
  std::string name;
  double p{1.0};
};

inline constexpr const char* kUnadjusted = ", unadjusted";

/// Tests of a family with the p values by which a report decides: Holm's. The p value before the
/// adjustment is a test of its own, if the family has several tests.
/// @param prefix  in front of each name: "planned: "
std::vector<NamedTest> named_tests(const TestFamily& family, const std::string& prefix);

/// Tests that a study's design calls for, with participants as the unit.
struct DesignTests {
  std::string design;                   // in words: "one factor within participants: condition"
  std::vector<std::string> incomplete;  // subjects without a value in each of their cells
  std::vector<Defined<EffectTest>> effects;
  Defined<RankAnova> ranks{Undefined{"it is for one factor"}};  // Friedman, or Kruskal and Wallis
  TestFamily planned;
  std::optional<SequentialResult> sequential;  // of the quantity that decides when a study ends
  bool ends_by_rule{false};                    // the study, by this or another quantity
  std::vector<TestFamily> families;            // without a hypothesis: two-tailed
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
/// | three or four | each factor and combination, marginal squares (type III) |
/// | more, or combinations that nobody had | none: cells are compared two by two |
///
/// With a covariate, one factor also has its analysis of covariance (covariate_tests.h).
DesignTests design_tests(const DesignTable& table, const AnalysisPlan& plan,
                         const Resampling& resampling);

/// @throws InputError where a plan names what the table does not have, or compares trials with
/// themselves.
void check_plan(const DesignTable& table, const AnalysisPlan& plan);

}  // namespace haptrial::analysis
