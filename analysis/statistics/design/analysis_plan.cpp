#include "analysis/statistics/design/analysis_plan.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <utility>

#include "core/base/definition/schema.h"
#include "core/base/error.h"
#include "core/base/nearest.h"

namespace haptrial::analysis {
namespace {

constexpr std::array<std::pair<std::string_view, Tail>, 3> kSigns{
    {{" < ", Tail::kLess}, {" > ", Tail::kGreater}, {" != ", Tail::kTwoSided}}};
constexpr const char* kForm = "two conditions with <, > or != between them, as \"visual < haptic\"";

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(' ');
  return first == std::string_view::npos
             ? std::string_view()
             : text.substr(first, text.find_last_not_of(' ') - first + 1);
}

/// Splits a test at its only sign.
/// @param blanks  whether the sign stands between blanks
std::optional<PlannedTest> split_test(std::string_view text, bool blanks) {
  std::optional<PlannedTest> found;
  for (const auto& [spaced, tail] : kSigns) {
    const std::string_view sign = blanks ? spaced : trimmed(spaced);
    for (auto at = text.find(sign); at != std::string_view::npos; at = text.find(sign, at + 1)) {
      if (found) {
        return std::nullopt;  // a second sign
      }
      found = PlannedTest{std::string(trimmed(text.substr(0, at))),
                          std::string(trimmed(text.substr(at + sign.size()))), tail};
    }
  }
  return found && !found->a.empty() && !found->b.empty() ? found : std::nullopt;
}

/// A sign between blanks divides the sides, so that levels may have signs, as "<50 ms != >90 ms";
/// without such a sign one without blanks does.
std::optional<PlannedTest> parsed(std::string_view text) {
  const auto spaced = split_test(text, true);
  return spaced ? spaced : split_test(text, false);
}

/// Sentence on two tests of the same two sides, which the adjustment would count twice; empty
/// without.
std::string repeated_test(const std::vector<PlannedTest>& tests) {
  for (std::size_t i = 0; i < tests.size(); ++i) {
    for (std::size_t k = i + 1; k < tests.size(); ++k) {
      if (std::minmax(tests[i].a, tests[i].b) == std::minmax(tests[k].a, tests[k].b)) {
        return fmt::format("compares {} and {} twice; state each pair once", tests[i].a,
                           tests[i].b);
      }
    }
  }
  return "";
}

/// Fault of tests that can be read; empty if there is none.
std::string problem_with(const std::vector<PlannedTest>& tests) {
  for (const PlannedTest& test : tests) {
    if (test.a == test.b) {
      return fmt::format("compares {} with itself; name two conditions", test.a);
    }
  }
  return repeated_test(tests);
}

const Schema<TestsBeside>& beside_keys() {
  using B = TestsBeside;
  static const auto schema =
      Schema<B>()
          .flag("bayes_factors", &B::bayes_factors,
                "Whether planned tests have Bayes factors: of the effect against none, with a "
                "Cauchy prior of scale 0.707 on its size, on one side for a directed test")
          .number("equivalence", &B::equivalence, {0.0, 1e9}, "",
                  "Largest difference that counts as none, in the unit of the tested values (of "
                  "thresholds on a logarithmic scale a difference of logarithms: 0.1 of log10 is a "
                  "factor of 1.26): planned tests also say whether the difference lies within it, "
                  "by two one-sided tests; 0: they do not")
          .text("equivalence_of", &B::equivalence_of,
                "The quantity whose differences the bound is of, by its name in results.json; "
                "others have no such test")
          .otherwise("the first that is compared")
          .number("trimmed", &B::trimmed, {0.0, 0.4}, "1",
                  "Share of the participants at each end whom a robust test beside each planned "
                  "one leaves out (Yuen's test of trimmed means), such as 0.2; 0: there is none");
  return schema;
}

/// The test that decides is a planned one, written as it stands there but for blanks.
void check_decisive(Table& table, AnalysisPlan& plan) {
  if (!plan.sequential) {
    return;
  }
  std::vector<std::string> allowed;
  for (const PlannedTest& test : plan.tests) {
    allowed.push_back(text_of(test));
  }
  const auto test = parsed(plan.sequential->test);
  plan.sequential->test = test ? text_of(*test) : plan.sequential->test;
  if (plan.tests.empty()) {
    table.reject("sequential", "without a planned test");
    plan.sequential.reset();
  } else if (!plan.sequential->test.empty() &&
             std::ranges::find(allowed, plan.sequential->test) == allowed.end()) {
    table.reject("sequential.test", fmt::format("\"{}\"", plan.sequential->test),
                 fmt::format("a planned test: \"{}\"", fmt::join(allowed, "\", \"")));
    plan.sequential.reset();
  }
}

}  // namespace

AnalysisPlan parse_analysis_plan(const std::vector<std::string>& tests,
                                 const std::string& reference, std::string_view where) {
  AnalysisPlan plan;
  plan.reference = reference;
  for (const std::string& text : tests) {
    const auto test = parsed(text);
    if (!test) {
      throw InputError(fmt::format("{} is \"{}\"; allowed: {}", where, text, kForm));
    }
    plan.tests.push_back(*test);
  }
  if (const std::string problem = problem_with(plan.tests); !problem.empty()) {
    throw InputError(fmt::format("{} {}", where, problem));
  }
  return plan;
}

std::string text_of(const PlannedTest& test) {
  const auto sign = std::find_if(kSigns.begin(), kSigns.end(),
                                 [&](const auto& each) { return each.second == test.tail; });
  return fmt::format("{}{}{}", test.a, sign->first, test.b);
}

const Schema<AnalysisPlan>& tests_beside_schema() {
  using P = AnalysisPlan;
  static const auto schema =
      Schema<P>()
          .keys_of(&P::beside, beside_keys())
          .table("sequential", &P::sequential, sequential_schema(),
                 "When the study may end before its last participant, by one of its planned tests")
          .check(check_decisive);
  return schema;
}

AnalysisPlan with_tests(AnalysisPlan plan, std::vector<PlannedTest> tests) {
  if (plan.sequential && !plan.tests.empty()) {
    plan.decides = decisive_test(plan);
  }
  plan.tests = std::move(tests);
  return plan;
}

const PlannedTest& decisive_test(const AnalysisPlan& plan) {
  if (plan.decides) {
    return *plan.decides;
  }
  const auto found = std::ranges::find(plan.tests, plan.sequential->test,
                                       [](const PlannedTest& test) { return text_of(test); });
  return found != plan.tests.end() ? *found : plan.tests.front();
}

AnalysisPlan read_analysis_plan(Table& analysis, const std::vector<std::string>& conditions,
                                std::string_view stated_in) {
  const auto check = [&](Table& table, const std::string& key, const std::string& name) {
    if (std::find(conditions.begin(), conditions.end(), name) == conditions.end()) {
      const std::string hint = did_you_mean(name, conditions);
      table.reject(key, fmt::format("names '{}', which {} lacks{} allowed: {}", name, stated_in,
                                    hint.empty() ? ";" : hint, fmt::join(conditions, ", ")));
    }
  };
  using P = AnalysisPlan;
  return Schema<P>()
      .custom("planned",
              "Tests between conditions that were planned before the data: \"a < b\", \"a > b\" or "
              "\"a != b\"",
              [&](Table& table, const std::string& key, P& plan) {
                for (const std::string& text : table.texts(key)) {
                  const auto test = parsed(text);
                  if (!test) {
                    table.reject(key, fmt::format("an array with \"{}\"", text), kForm);
                    continue;
                  }
                  check(table, key, test->a);
                  check(table, key, test->b);
                  plan.tests.push_back(*test);
                }
                if (const std::string problem = problem_with(plan.tests); !problem.empty()) {
                  table.reject(key, problem);
                }
              })
      .otherwise("none")
      .custom("reference", "Condition with which the others are compared",
              [&](Table& table, const std::string& key, P& plan) {
                plan.reference = table.text(key);
                check(table, key, plan.reference);
              })
      .otherwise("the first")
      .check([](Table& table, P& plan) { tests_beside_schema().read(table, plan); })
      .read(analysis);
}

}  // namespace haptrial::analysis
