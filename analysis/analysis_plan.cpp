#include "analysis/analysis_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "core/base/error.h"
#include "core/base/nearest.h"
#include "core/base/table.h"

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

std::optional<PlannedTest> parsed(std::string_view text) {
  std::optional<PlannedTest> found;
  for (const auto& [sign, tail] : kSigns) {
    const auto at = text.find(sign);
    if (at == std::string_view::npos) {
      continue;
    }
    const auto a = trimmed(text.substr(0, at));
    const auto b = trimmed(text.substr(at + sign.size()));
    if (found || a.empty() || b.empty() || a == b || b.find(sign) != std::string_view::npos) {
      return std::nullopt;
    }
    found = PlannedTest{std::string(a), std::string(b), tail};
  }
  return found;
}

}  // namespace

PlannedTest parse_planned_test(std::string_view text, std::string_view where) {
  auto test = parsed(text);
  if (!test) {
    throw InputError(fmt::format("{} is \"{}\"; allowed: {}", where, text, kForm));
  }
  return std::move(*test);
}

std::string text_of(const PlannedTest& test) {
  const auto sign = std::find_if(kSigns.begin(), kSigns.end(),
                                 [&](const auto& each) { return each.second == test.tail; });
  return fmt::format("{}{}{}", test.a, sign->first, test.b);
}

AnalysisPlan read_analysis_plan(Table& analysis, const std::vector<std::string>& conditions) {
  AnalysisPlan plan;
  const auto check = [&](const char* key, const std::string& name) {
    if (std::find(conditions.begin(), conditions.end(), name) == conditions.end()) {
      const std::string hint = did_you_mean(name, conditions);
      analysis.reject(key,
                      fmt::format("names '{}', which design.conditions lacks{} allowed: {}", name,
                                  hint.empty() ? ";" : hint, fmt::join(conditions, ", ")));
    }
  };
  if (analysis.has("planned")) {
    for (const std::string& text : analysis.texts("planned")) {
      const auto test = parsed(text);
      if (!test) {
        analysis.reject("planned", fmt::format("an array with \"{}\"", text), kForm);
        continue;
      }
      check("planned", test->a);
      check("planned", test->b);
      plan.tests.push_back(*test);
    }
  }
  if (analysis.has("reference")) {
    plan.reference = analysis.text("reference");
    check("reference", plan.reference);
  }
  return plan;
}

}  // namespace haptrial::analysis
