#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "analysis/t_test.h"

namespace haptrial {
class Table;
}

namespace haptrial::analysis {

/// A test that was planned before the data: mean(a) < mean(b), > or, two-tailed, !=.
struct PlannedTest {
  std::string a;
  std::string b;
  Tail tail{Tail::kTwoSided};
};

/// What the experimenter decided before the data. Source: Morris 2006, §4.4, for the shipped study.
struct AnalysisPlan {
  std::vector<PlannedTest> tests;
  std::string reference;  // the condition that the others are compared with; empty: the first
};

/// "visual < haptic". A side is a condition, or in a study
/// of several factors a level of one of them. @throws InputError, with `where` in front.
PlannedTest parse_planned_test(std::string_view text, std::string_view where);

/// The same again.
std::string text_of(const PlannedTest& test);

/// Sentence on two tests of the same two sides, which the adjustment would count twice; empty
/// without.
std::string repeated_test(const std::vector<PlannedTest>& tests);

/// The optional keys `planned` and `reference` of an [analysis] table. Names that are not of
/// `conditions` are noted as problems of the table.
AnalysisPlan read_analysis_plan(Table& analysis, const std::vector<std::string>& conditions);

}  // namespace haptrial::analysis
