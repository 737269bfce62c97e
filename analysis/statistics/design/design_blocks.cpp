#include "analysis/statistics/design/design_blocks.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <vector>

#include "analysis/statistics/design/wording.h"

namespace haptrial::analysis {
namespace {

using TextRows = std::vector<std::vector<std::string>>;

std::string sides_text(const SideTest& test) {
  return test.sides.tail == Tail::kTwoSided ? test.sides.a + " and " + test.sides.b
                                            : text_of(test.sides);
}

void add_family(Document& document, const TestFamily& family) {
  TextRows rows;
  for (const SideTest& test : family.tests) {
    rows.push_back(
        {sides_text(test),
         test.paired ? counted(test.count_a, "pair")
                     : fmt::format("{} and {}", test.count_a, test.count_b),
         test.t ? fmt::format("{} [{}, {}]", number(test.t->difference), number(test.t->low),
                              number(test.t->high))
                : "–",
         test.t ? (test.paired ? "paired " : "Welch's ") + t_result(test.t) : t_result(test.t),
         p_result(test.holm), effect(test.size), ranks_p(test), p_result(test.permutation_holm)});
  }
  if (!rows.empty()) {
    document.table({capitalized(family.name), "participants", "difference [95 %, not adjusted]",
                    "t-test, not adjusted", "p after Holm", "d_z or d", "ranks, p after Holm",
                    "permutation, p after Holm"},
                   rows);
  }
}

void add_effects(Document& document, const DesignTests& tests) {
  TextRows rows;
  for (const auto& effect : tests.effects) {
    if (effect) {
      rows.push_back({effect->factor, effect_result(*effect)});
    } else {
      document.paragraph("Whether conditions differ is not defined, because " + effect.because() +
                         ".");
    }
  }
  if (!rows.empty()) {
    document.table({"effect", "test"}, rows);
  }
}

}  // namespace

void add_design_tests(Document& document, const DesignTable& table, const DesignTests& tests,
                      const std::string& unit) {
  document.paragraph(fmt::format("Varied {}.{}", tests.design,
                                 unit.empty() ? "" : " Differences are in " + unit + "."));
  add_effects(document, tests);
  if (table.factors.size() == 1) {
    document.paragraph(fmt::format("On ranks ({}): {}.",
                                   table.factors[0].within ? "Friedman" : "Kruskal–Wallis",
                                   rank_result(tests.ranks)));
  }
  if (!tests.incomplete.empty()) {
    document.paragraph(fmt::format("Left out for lack of a value in some condition: {}.",
                                   fmt::join(tests.incomplete, ", ")));
  }
  add_family(document, tests.planned);
  if (tests.sequential) {
    add_looks(document, *tests.sequential);
  } else if (tests.ends_by_rule) {
    document.paragraph(
        "These p values and intervals take the number of participants as fixed beforehand, "
        "although "
        "a rule ends the study by another quantity.");
  }
  for (const TestFamily& family : tests.families) {
    add_family(document, family);
  }
}

void add_looks(Document& document, const SequentialResult& result) {
  constexpr std::size_t kMost = 12;  // rows: the last ones
  document.paragraph(fmt::format(
      "When the study ends: {} The p values and intervals of this page take the number of "
      "participants as fixed beforehand; that the study may end for an effect without one with a "
      "probability of at most {:g} holds for the decision alone.",
      words_of(result), result.plan.error));
  TextRows rows;
  const std::size_t first = result.looks.size() - std::min(kMost, result.looks.size());
  for (std::size_t i = first; i < result.looks.size(); ++i) {
    const SequentialLook& look = result.looks[i];
    rows.push_back(
        {fmt::format("{}", look.participants),
         look.value ? number(*look.value) : "not defined, because " + look.value.because(),
         number(look.bound)});
  }
  if (!rows.empty()) {
    document.table({"participants",
                    result.plan.rule == StopRule::kBayesFactor ? "Bayes factor" : "z", "bound"},
                   rows, first > 0 ? "The last looks" : "Looks");
  }
}

}  // namespace haptrial::analysis
