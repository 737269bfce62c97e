#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "analysis/statistics/tests/t_tests.h"

namespace haptrial {
class Table;
}

namespace haptrial::analysis {

/// A test that was planned before the data: mean(a) < mean(b), > or, two-tailed, !=.
struct PlannedTest {
  std::string a;
  std::string b;
  Tail tail{Tail::kTwoSided};
  bool bayes_factor{false};  // it is given beside p
};

/// The experimenter's decisions before the data. Source: Morris 2006, §4.4, for the shipped study.
struct AnalysisPlan {
  std::vector<PlannedTest> tests;
  std::string reference;  // the condition that the others are compared with; empty: the first
};

/// A plan in words. Each test is as "visual < haptic"; a side is a condition, or in a study of
/// several factors a level of one of them.
/// @throws InputError, with `where` in front, for a test that cannot be read, compares something
/// with itself, or stands twice in either direction.
AnalysisPlan parse_analysis_plan(const std::vector<std::string>& tests,
                                 const std::string& reference, std::string_view where);

/// The same again.
std::string text_of(const PlannedTest& test);

/// Asks for the Bayes factor of each test. Key `bayes_factors` of an [analysis] table.
void ask_for_bayes_factors(AnalysisPlan& plan);
inline constexpr const char* kBayesFactorsText =
    "Whether planned tests have Bayes factors: of the effect against none, with a Cauchy prior of "
    "scale 0.707 on its size, on one side for a directed test";

/// The optional keys `planned`, `bayes_factors` and `reference` of an [analysis] table. Names that are not of
/// `conditions` are noted as problems of the table.
AnalysisPlan read_analysis_plan(Table& analysis, const std::vector<std::string>& conditions);

}  // namespace haptrial::analysis
