#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/statistics/design/sequential_plan.h"
#include "analysis/statistics/tests/t_tests.h"

namespace haptrial {

class Table;
template <class T>
class Schema;
}  // namespace haptrial

namespace haptrial::analysis {

/// A test that was planned before the data: mean(a) < mean(b), > or, two-tailed, !=.
struct PlannedTest {
  std::string a;
  std::string b;
  Tail tail{Tail::kTwoSided};
};

/// Tests that stand beside the t-test of each planned one.
struct TestsBeside {
  bool bayes_factors{false};
  double equivalence{0.0};  // largest difference that counts as none, in the values' unit; 0: none
  std::string equivalence_of;  // the quantity of that bound, as in results.json; empty: the first
  double trimmed{0.0};         // share of each tail that Yuen's test leaves out; 0: it is not made
};

/// A number of each participant for which planned tests are adjusted.
struct Covariate {
  std::string name;  // empty: there is none
  std::map<std::string, double> values{};
};

/// The experimenter's decisions before the data. Source: Morris 2006, §4.4, for the shipped study.
struct AnalysisPlan {
  std::vector<PlannedTest> tests;
  std::string reference;  // the condition that the others are compared with; empty: the first
  TestsBeside beside{};
  Covariate covariate{};
  std::optional<SequentialPlan> sequential{};  // none: everybody comes before the first test
  std::optional<PlannedTest> decides{};        // if `tests` are others than the definition's
};

/// A plan in words. Each test is as "visual < haptic"; a side is a condition, or in a study of
/// several factors a level of one of them.
/// @throws InputError, with `where` in front, for a test that cannot be read, compares something
/// with itself, or stands twice in either direction.
AnalysisPlan parse_analysis_plan(const std::vector<std::string>& tests,
                                 const std::string& reference, std::string_view where);

/// The same again.
std::string text_of(const PlannedTest& test);

/// The keys of an [analysis] table that ask for tests beside the planned ones, and that say which
/// of them decides when the study ends; read after the planned tests.
const Schema<AnalysisPlan>& tests_beside_schema();
/// The plan with other tests in place of its own; all else stays, and so does the test that decides
/// when the study ends.
AnalysisPlan with_tests(AnalysisPlan plan, std::vector<PlannedTest> tests);
/// The planned test that decides. @param plan  with `sequential`, whose test is a planned one
const PlannedTest& decisive_test(const AnalysisPlan& plan);

/// The optional keys `planned` and `reference` of an [analysis] table, and those of
/// tests_beside_schema(). Names that are not of `conditions` are noted as problems of the table.
/// @param stated_in  what lists the conditions, for sentences
AnalysisPlan read_analysis_plan(Table& analysis, const std::vector<std::string>& conditions,
                                std::string_view stated_in = "design.conditions");

}  // namespace haptrial::analysis
