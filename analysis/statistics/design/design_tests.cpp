#include "analysis/statistics/design/design_tests.h"

#include <fmt/format.h>

#include <algorithm>
#include <type_traits>

#include "analysis/statistics/base/p_adjust.h"
#include "analysis/statistics/design/covariate_tests.h"
#include "analysis/statistics/design/design_sides.h"
#include "core/base/error.h"

namespace haptrial::analysis {
namespace {

template <class Member, class Adjusted>
void adjust(std::vector<SideTest>& tests, Member member, Adjusted adjusted) {
  std::vector<std::decay_t<decltype(tests.front().*member)>> all;
  for (const SideTest& test : tests) {
    all.push_back(test.*member);
  }
  const auto p_values = holm_over(all);
  for (std::size_t i = 0; i < tests.size(); ++i) {
    tests[i].*adjusted = p_values[i];
  }
}

TestFamily planned_tests(const DesignTable& table, const AnalysisPlan& plan,
                         const Resampling& resampling) {
  TestFamily family{"planned", {}};
  for (const PlannedTest& test : plan.tests) {
    family.tests.push_back(compared(table, test, cells_of(table, test.a), cells_of(table, test.b),
                                    resampling, plan.beside, plan.covariate));
  }
  adjust(family);
  return family;
}

TestFamily levels_of(const DesignTable& table, std::size_t factor, const Resampling& resampling) {
  const Factor& f = table.factors[factor];
  TestFamily family{"every two levels of " + f.name, {}};
  for (std::size_t i = 0; i < f.levels.size(); ++i) {
    for (std::size_t k = i + 1; k < f.levels.size(); ++k) {
      family.tests.push_back(compared(table, {f.levels[i], f.levels[k], Tail::kTwoSided},
                                      cells_at(table, factor, i), cells_at(table, factor, k),
                                      resampling));
    }
  }
  adjust(family);
  return family;
}

/// Two cells that differ in one factor.
TestFamily neighbouring_cells(const DesignTable& table, const Resampling& resampling) {
  TestFamily family{"every two cells that differ in one factor", {}};
  for (std::size_t i = 0; i < table.cells.size(); ++i) {
    for (std::size_t k = i + 1; k < table.cells.size(); ++k) {
      std::size_t different = 0;
      for (std::size_t f = 0; f < table.factors.size(); ++f) {
        different += table.cells[i][f] != table.cells[k][f] ? 1 : 0;
      }
      if (different == 1) {
        family.tests.push_back(compared(table, {table.names[i], table.names[k], Tail::kTwoSided},
                                        {i}, {k}, resampling));
      }
    }
  }
  adjust(family);
  return family;
}

/// ", as S03 has several" where a few participants alone make a factor one within; else empty.
std::string exceptions(const DesignTable& table, std::size_t factor) {
  const auto several = table.with_several(factor);
  return !several.empty() && 2 * several.size() < table.subjects.size()
             ? fmt::format(", as {} {} several", fmt::join(several, ", "),
                           several.size() == 1 ? "has" : "have")
             : "";
}

std::string design_in_words(const DesignTable& table) {
  std::string text;
  for (const bool within : {true, false}) {
    std::vector<std::string> names;
    for (std::size_t f = 0; f < table.factors.size(); ++f) {
      const Factor& factor = table.factors[f];
      if (factor.within == within && factor.levels.size() > 1) {
        names.push_back(fmt::format("{} ({}{})", factor.name, fmt::join(factor.levels, ", "),
                                    exceptions(table, f)));
      }
    }
    if (!names.empty()) {
      text += fmt::format("{}{} participants: {}", text.empty() ? "" : "; ",
                          within ? "within" : "between", fmt::join(names, " and "));
    }
  }
  return text.empty()
             ? fmt::format("nothing: there is one condition, {}", fmt::join(table.names, ", "))
             : text;
}

}  // namespace

void adjust(TestFamily& family) {
  adjust(family.tests, &SideTest::t, &SideTest::holm);
  adjust(family.tests, &SideTest::ranks, &SideTest::ranks_holm);
  adjust(family.tests, &SideTest::permutation, &SideTest::permutation_holm);
  adjust(family.tests, &SideTest::equivalence, &SideTest::equivalence_holm);
  adjust(family.tests, &SideTest::trimmed, &SideTest::trimmed_holm);
  adjust(family.tests, &SideTest::adjusted, &SideTest::adjusted_holm);
}

std::vector<NamedTest> named_tests(const TestFamily& family, const std::string& prefix) {
  std::vector<NamedTest> named;
  for (const SideTest& test : family.tests) {
    const auto note = [&](const std::string& kind, const auto& found, const auto& adjusted) {
      if (!found) {
        return;
      }
      const std::string name = prefix + text_of(test.sides) + ", " + kind;
      named.push_back({name, *adjusted});
      if (family.tests.size() > 1) {
        named.push_back({name + kUnadjusted, found->p});
      }
    };
    note(name_of_test(test), test.t, test.holm);
    note("ranks", test.ranks, test.ranks_holm);
    note("permutation", test.permutation, test.permutation_holm);
    note("equivalence", test.equivalence, test.equivalence_holm);
    note("trimmed means", test.trimmed, test.trimmed_holm);
    note("adjusted for " + test.covariate, test.adjusted, test.adjusted_holm);
  }
  return named;
}

void check_plan(const DesignTable& table, const AnalysisPlan& plan) {
  const auto known = known_sides(table);
  const auto require = [&](const std::string& side, const char* what) {
    if (cells_of(table, side).empty()) {
      throw InputError(fmt::format("the {} names '{}', which the data do not have; allowed: '{}'",
                                   what, side, fmt::join(known, "', '")));
    }
  };
  for (const PlannedTest& test : plan.tests) {
    require(test.a, "planned test");
    require(test.b, "planned test");
    const Cells a = cells_of(table, test.a);
    const Cells b = cells_of(table, test.b);
    if (std::find_first_of(a.begin(), a.end(), b.begin(), b.end()) != a.end()) {
      throw InputError(
          fmt::format("the planned test \"{}\" compares trials with themselves", text_of(test)));
    }
  }
  if (!plan.reference.empty()) {
    require(plan.reference, "reference condition");
  }
}

DesignTests design_tests(const DesignTable& table, const AnalysisPlan& plan,
                         const Resampling& resampling) {
  DesignTests tests;
  tests.design = design_in_words(table);
  const auto complete = table.complete();
  for (std::size_t s = 0; s < table.subjects.size(); ++s) {
    if (std::find(complete.begin(), complete.end(), s) == complete.end()) {
      tests.incomplete.push_back(table.subjects[s]);
    }
  }
  tests.effects = design_effects(table);
  if (!plan.covariate.name.empty()) {
    tests.effects.push_back(adjusted_effect(table, plan.covariate));
  }
  tests.ranks = design_ranks(table);
  tests.planned = planned_tests(table, plan, resampling);
  for (std::size_t f = 0; f < table.factors.size(); ++f) {
    if (table.factors[f].levels.size() > 1 && (table.crossed || table.factors.size() == 1)) {
      tests.families.push_back(levels_of(table, f, resampling));
    }
  }
  const auto varied = std::count_if(table.factors.begin(), table.factors.end(),
                                    [](const Factor& f) { return f.levels.size() > 1; });
  if (varied > 1) {
    tests.families.push_back(neighbouring_cells(table, resampling));
  }
  return tests;
}

}  // namespace haptrial::analysis
