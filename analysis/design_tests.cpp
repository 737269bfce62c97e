#include "analysis/design_tests.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <utility>

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

/// The values of two sides: pairs of the same participants, or different people. By stratum where
/// other factors between participants lie across both sides.
struct Sides {
  std::vector<double> a, b;
  std::map<std::vector<std::size_t>, std::pair<std::vector<double>, std::vector<double>>> strata;
  bool paired{false};

  void add(const std::vector<std::size_t>& stratum, std::optional<double> first,
           std::optional<double> second) {
    auto& [in_a, in_b] = strata[stratum];
    if (first) {
      a.push_back(*first);
      in_a.push_back(*first);
    }
    if (second) {
      b.push_back(*second);
      in_b.push_back(*second);
    }
  }
};

std::set<std::size_t> levels_in(const DesignTable& table, const Cells& cells, std::size_t factor) {
  std::set<std::size_t> levels;
  for (const std::size_t cell : cells) {
    levels.insert(table.cells[cell][factor]);
  }
  return levels;
}

/// Factors between participants of which both sides have the same levels, several.
std::vector<std::size_t> factors_across(const DesignTable& table, const Cells& a, const Cells& b) {
  std::vector<std::size_t> across;
  for (std::size_t f = 0; f < table.factors.size(); ++f) {
    const auto levels = levels_in(table, a, f);
    if (!table.factors[f].within && levels.size() > 1 && levels == levels_in(table, b, f)) {
      across.push_back(f);
    }
  }
  return across;
}

std::vector<std::size_t> stratum_of(const DesignTable& table, std::size_t subject,
                                    const std::vector<std::size_t>& factors) {
  const auto& means = table.means[subject];
  const auto own = std::find_if(means.begin(), means.end(), [](const auto& m) { return !!m; });
  std::vector<std::size_t> stratum;
  for (const std::size_t f : factors) {
    stratum.push_back(table.cells[static_cast<std::size_t>(own - means.begin())][f]);
  }
  return stratum;
}

/// A side of one cell takes everybody who has it; one of several takes who has all of their own.
Sides values_of(const DesignTable& table, const Cells& a, const Cells& b) {
  const bool single = a.size() == 1 && b.size() == 1;
  std::vector<std::size_t> subjects = table.complete();
  if (single) {
    subjects.resize(table.subjects.size());
    std::iota(subjects.begin(), subjects.end(), std::size_t{0});
  }
  const auto across = factors_across(table, a, b);
  Sides paired;
  paired.paired = true;
  Sides apart;
  for (const std::size_t subject : subjects) {
    const auto first = side_of(table, subject, a);
    const auto second = side_of(table, subject, b);
    const auto stratum = stratum_of(table, subject, across);
    if (first && second) {
      paired.add(stratum, first, second);
    }
    apart.add(stratum, first, second);
  }
  return paired.a.empty() ? apart : paired;
}

bool equally_large(const Sides& sides) {
  const auto& [a, b] = sides.strata.begin()->second;
  return std::all_of(sides.strata.begin(), sides.strata.end(), [&](const auto& stratum) {
    return stratum.second.first.size() == a.size() && stratum.second.second.size() == b.size();
  });
}

Defined<TTest> stratified(const Sides& sides, Tail tail) {
  std::vector<std::vector<double>> a;
  std::vector<std::vector<double>> b;
  for (const auto& [key, values] : sides.strata) {
    const auto& [first, second] = values;
    if (!sides.paired) {
      a.push_back(first);
      b.push_back(second);
      continue;
    }
    auto& differences = a.emplace_back();
    for (std::size_t i = 0; i < first.size(); ++i) {
      differences.push_back(first[i] - second[i]);
    }
  }
  return stratified_t_test(a, b, tail);
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
  if (values.strata.size() > 1 && !equally_large(values)) {
    const Undefined why{"groups of different size are weighed alike, which only the t-test does"};
    test.t = stratified(values, tail);
    test.size = why;
    test.ranks = why;
    test.permutation = why;
    test.bootstrap = why;
    return test;
  }
  if (values.paired) {
    test.t = paired_t_test(values.a, values.b, tail);
    test.size = cohens_dz(values.a, values.b);
    test.ranks = wilcoxon_signed_rank(values.a, values.b, tail);
  } else {
    test.t = welch_t_test(values.a, values.b, tail);
    test.size = cohens_d(values.a, values.b);
    test.ranks = mann_whitney(values.a, values.b, tail);
  }
  if (values.strata.size() > 1) {
    test.t = stratified(values, tail);
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
      if (factor.within == within && factor.levels.size() > 1) {
        names.push_back(fmt::format("{} ({})", factor.name, fmt::join(factor.levels, ", ")));
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
  const auto varied = std::count_if(table.factors.begin(), table.factors.end(),
                                    [](const Factor& f) { return f.levels.size() > 1; });
  if (varied > 1) {
    tests.families.push_back(neighbouring_cells(table, resampling));
  }
  return tests;
}

}  // namespace haptrial::analysis
