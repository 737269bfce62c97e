#include "analysis/design_tests.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "analysis/design_effects.h"
#include "analysis/p_adjust.h"
#include "core/base/error.h"

namespace haptrial::analysis {
namespace {

using Cells = std::vector<std::size_t>;

Cells cells_at(const DesignTable& table, std::size_t factor, std::size_t level) {
  Cells cells;
  for (std::size_t cell = 0; cell < table.cells.size(); ++cell) {
    if (table.cells[cell][factor] == level) {
      cells.push_back(cell);
    }
  }
  return cells;
}

/// The cells of a condition, or of a level of one factor; none of a name that has no trials.
Cells cells_of(const DesignTable& table, const std::string& side) {
  const auto cell = std::find(table.names.begin(), table.names.end(), side);
  if (cell != table.names.end()) {
    return {static_cast<std::size_t>(cell - table.names.begin())};
  }
  Cells found;
  for (std::size_t f = 0; f < table.factors.size(); ++f) {
    const auto& levels = table.factors[f].levels;
    const auto level = std::find(levels.begin(), levels.end(), side);
    if (level == levels.end()) {
      continue;
    }
    if (!found.empty()) {
      throw InputError(fmt::format(
          "the planned test of '{}' could mean a level of several factors; name levels differently",
          side));
    }
    found = cells_at(table, f, static_cast<std::size_t>(level - levels.begin()));
  }
  return found;
}

std::vector<std::string> known_sides(const DesignTable& table) {
  std::vector<std::string> known = table.names;
  if (table.factors.size() > 1) {
    for (const Factor& factor : table.factors) {
      known.insert(known.end(), factor.levels.begin(), factor.levels.end());
    }
  }
  return known;
}

/// The mean of a participant's cells of a side; nothing without any.
std::optional<double> side_of(const DesignTable& table, std::size_t subject, const Cells& cells) {
  double sum = 0.0;
  std::size_t count = 0;
  for (const std::size_t cell : cells) {
    if (const auto& mean = table.means[subject][cell]) {
      sum += *mean;
      ++count;
    }
  }
  return count > 0 ? std::optional(sum / static_cast<double>(count)) : std::nullopt;
}

struct Sides {
  std::vector<double> a, b;
  bool paired{false};
};

Sides values_of(const DesignTable& table, const Cells& a, const Cells& b) {
  Sides paired{{}, {}, true};
  Sides apart;
  for (const std::size_t subject : table.complete()) {
    const auto first = side_of(table, subject, a);
    const auto second = side_of(table, subject, b);
    if (first && second) {
      paired.a.push_back(*first);
      paired.b.push_back(*second);
    }
    if (first) {
      apart.a.push_back(*first);
    }
    if (second) {
      apart.b.push_back(*second);
    }
  }
  return paired.a.empty() ? apart : paired;
}

void resample(SideTest& test, const Sides& values, Resampling resampling) {
  const Tail tail = test.sides.tail;
  resampling.stream = "permutation of " + text_of(test.sides);
  test.permutation = test.paired ? sign_flip_test(values.a, values.b, tail, resampling)
                                 : permutation_test(values.a, values.b, tail, resampling);
  resampling.stream = "bootstrap of " + text_of(test.sides);
  if (!test.paired) {
    test.bootstrap = bootstrap_difference(values.a, values.b, resampling);
    return;
  }
  std::vector<double> differences(values.a.size());
  std::transform(values.a.begin(), values.a.end(), values.b.begin(), differences.begin(),
                 [](double a, double b) { return a - b; });
  test.bootstrap = bootstrap(
      differences,
      [](std::span<const double> drawn) {
        double sum = 0.0;
        for (const double value : drawn) {
          sum += value;
        }
        return sum / static_cast<double>(drawn.size());
      },
      resampling);
}

SideTest compared(const DesignTable& table, PlannedTest sides, const Cells& a, const Cells& b,
                  const Resampling& resampling) {
  const Sides values = values_of(table, a, b);
  SideTest test;
  test.sides = std::move(sides);
  test.paired = values.paired;
  test.count_a = values.a.size();
  test.count_b = values.b.size();
  const Tail tail = test.sides.tail;
  if (values.paired) {
    test.t = paired_t_test(values.a, values.b, tail);
    test.size = cohens_dz(values.a, values.b);
    test.ranks = wilcoxon_signed_rank(values.a, values.b, tail);
  } else {
    test.t = welch_t_test(values.a, values.b, tail);
    test.size = cohens_d(values.a, values.b);
    test.ranks = mann_whitney(values.a, values.b, tail);
  }
  if (resampling.count > 0) {
    resample(test, values, resampling);
  }
  return test;
}

SideTest without_trials(const PlannedTest& sides, const std::string& missing) {
  const Undefined why{fmt::format("there are no trials of '{}'", missing)};
  SideTest test;
  test.sides = sides;
  test.t = why;
  test.size = why;
  test.ranks = why;
  test.permutation = why;
  test.bootstrap = why;
  return test;
}

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

void adjust(TestFamily& family) {
  adjust(family.tests, &SideTest::t, &SideTest::holm);
  adjust(family.tests, &SideTest::ranks, &SideTest::ranks_holm);
  adjust(family.tests, &SideTest::permutation, &SideTest::permutation_holm);
}

TestFamily planned_tests(const DesignTable& table, const AnalysisPlan& plan,
                         const Resampling& resampling) {
  TestFamily family{"planned", {}};
  for (const PlannedTest& test : plan.tests) {
    const Cells a = cells_of(table, test.a);
    const Cells b = cells_of(table, test.b);
    if (a.empty() || b.empty()) {
      family.tests.push_back(without_trials(test, a.empty() ? test.a : test.b));
    } else {
      family.tests.push_back(compared(table, test, a, b, resampling));
    }
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

std::string design_in_words(const DesignTable& table) {
  std::string text;
  for (const bool within : {true, false}) {
    std::vector<std::string> names;
    for (const Factor& factor : table.factors) {
      if (factor.within == within) {
        names.push_back(fmt::format("{} ({})", factor.name, fmt::join(factor.levels, ", ")));
      }
    }
    if (!names.empty()) {
      text += fmt::format("{}{} participants: {}", text.empty() ? "" : "; ",
                          within ? "within" : "between", fmt::join(names, " and "));
    }
  }
  return text;
}

}  // namespace

void check_plan(const DesignTable& table, const AnalysisPlan& plan) {
  const auto known = known_sides(table);
  const auto require = [&](const std::string& side, const char* what) {
    if (cells_of(table, side).empty()) {
      throw InputError(fmt::format("the {} names '{}', of which there are no trials; allowed: {}",
                                   what, side, fmt::join(known, ", ")));
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

std::string name_of_test(const SideTest& test) { return test.paired ? "paired t" : "Welch's t"; }

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
  tests.ranks = design_ranks(table);
  tests.planned = planned_tests(table, plan, resampling);
  for (std::size_t f = 0; f < table.factors.size(); ++f) {
    if (table.factors[f].levels.size() > 1 && (table.crossed || table.factors.size() == 1)) {
      tests.families.push_back(levels_of(table, f, resampling));
    }
  }
  if (table.factors.size() > 1) {
    tests.families.push_back(neighbouring_cells(table, resampling));
  }
  return tests;
}

}  // namespace haptrial::analysis
