#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "analysis/force_training/report/report_parts.h"
#include "analysis/statistics/design/design_blocks.h"
#include "analysis/statistics/design/wording.h"

namespace haptrial::analysis {
namespace {

using Rows = std::vector<std::vector<std::string>>;

/// Mean of a side's participants: "M = 1.977, SD = 0.6644" of their means.
std::string mean_of(const StudyStatistics& s, const std::string& side) {
  const auto found = std::find_if(s.summaries.begin(), s.summaries.end(),
                                  [&](const auto& each) { return each.condition == side; });
  if (found == s.summaries.end() || !found->participants) {
    return "";
  }
  return fmt::format(" (M = {}, SD = {})", number(found->participants->mean),
                     number(found->participants->deviation));
}

/// Sentence about a planned test as journals want it.
std::string sentence(const StudyStatistics& s, const SideTest& test, const std::string& what) {
  constexpr double kAlpha = 0.05;
  const std::string& a = test.sides.a;
  const std::string& b = test.sides.b;
  const Tail tail = test.sides.tail;
  if (!test.t || !test.holm) {
    return fmt::format("The planned test {} is not defined, because {}.", text_of(test.sides),
                       test.t.because());
  }
  const char* direction = tail == Tail::kLess      ? "lower"
                          : tail == Tail::kGreater ? "higher"
                                                   : "different";
  return fmt::format("{} was {} {} after {}{} {} after {}{}: {}, {} = {}.", what,
                     *test.holm < kAlpha ? "significantly" : "not shown to be", direction, a,
                     mean_of(s, a), tail == Tail::kTwoSided ? "and" : "than", b, mean_of(s, b),
                     side_result(test), test.paired ? "d_z" : "d", effect(test.size));
}

/// A test on ranks and its adjusted p.
std::string ranks_result(const SideTest& test) {
  return test.ranks ? fmt::format("{} = {:g}, {}", test.paired ? "V" : "U", test.ranks->statistic,
                                  ranks_p(test))
                    : "not defined, because " + test.ranks.because();
}

std::string difference(const Defined<TTest>& test) {
  return test ? fmt::format("{} ({} to {})", number(test->difference), number(test->low),
                            number(test->high))
              : "-";
}

/// "0.023" or "< 0.001" under a heading that says that they are p values.
std::string bare(const Defined<double>& p) {
  const std::string text = p_result(p);
  const std::string equal = "p = ";
  return text.starts_with(equal)    ? text.substr(equal.size())
         : text.starts_with("p < ") ? text.substr(2)
                                    : text;
}

std::string participants_of(const SideTest& test) {
  return test.paired ? counted(test.count_a, "pair")
                     : fmt::format("{} and {}", test.count_a, test.count_b);
}

/// Whether a family's bootstrap intervals are printed at all.
bool has_bootstrap(const TestFamily& family) {
  return std::any_of(family.tests.begin(), family.tests.end(), [](const SideTest& test) {
    return test.bootstrap && std::min(test.count_a, test.count_b) >= kFewestForBootstrap;
  });
}

std::vector<std::string> row_of(const SideTest& test) {
  return {test.sides.tail == Tail::kTwoSided ? test.sides.a + " and " + test.sides.b
                                             : text_of(test.sides),
          participants_of(test),
          difference(test.t),
          test.t ? (test.paired ? "paired " : "Welch's ") + t_result(test.t) : t_result(test.t),
          bare(test.holm),
          effect(test.size),
          ranks_result(test),
          bare(test.permutation_holm)};
}

void add_family(Document& document, const TestFamily& family, const std::string& heading) {
  if (family.tests.empty()) {
    return;
  }
  std::vector<std::string> names{heading,
                                 "Participants",
                                 "Difference (95 % CI, not adjusted)",
                                 "t-test, not adjusted",
                                 "p after Holm",
                                 "d_z or d",
                                 "Ranks, p after Holm",
                                 "Permutation, p after Holm"};
  Rows rows;
  for (const SideTest& test : family.tests) {
    rows.push_back(row_of(test));
    if (has_bootstrap(family)) {
      rows.back().push_back(bootstrap_result(test));
    }
  }
  if (has_bootstrap(family)) {
    names.emplace_back("Bootstrap 95 % CI");
  }
  document.table(names, rows);
}

void add_effects(Document& document, const DesignTests& tests) {
  Rows rows;
  for (const auto& effect : tests.effects) {
    if (!effect) {
      document.paragraph("Whether conditions differ is not defined, because " + effect.because() +
                         ".");
      continue;
    }
    rows.push_back({effect->factor, effect_result(*effect),
                    effect->size ? fmt::format("{} to {}", number(effect->size->low),
                                               number(effect->size->high))
                                 : "-"});
  }
  if (!rows.empty()) {
    document.table({"Effect", "Test", "90 % CI of partial η²"}, rows);
  }
}

/// Adds the parts that only one factor within participants has.
void add_repeated(Document& document, const StudyStatistics& s) {
  if (s.table.factors.size() != 1 || !s.table.factors[0].within || !s.repeated) {
    return;
  }
  document.paragraph(fmt::format(
      "Without the correction for sphericity {}. {}{}", p_value(s.repeated->p),
      sphericity_result(s.repeated),
      s.generalized_eta ? fmt::format(" Generalized η² = {:.2g}.", *s.generalized_eta) : ""));
}

}  // namespace

void add_participants(Document& document, const StudyStatistics& s, const std::string& what) {
  document.subheading("Participants as the unit");
  document.paragraph(
      "Each participant gives one mean for each condition, so that trials of one participant are "
      "not counted as independent evidence. Varied " +
      s.tests.design + ".");
  add_effects(document, s.tests);
  add_repeated(document, s);
  if (s.table.factors.size() == 1) {
    document.paragraph(fmt::format("On ranks ({}): {}.",
                                   s.table.factors[0].within ? "Friedman" : "Kruskal–Wallis",
                                   rank_result(s.tests.ranks)));
  }
  if (!s.tests.incomplete.empty()) {
    document.paragraph("Left out for lack of a scored trial in some condition: " +
                       joined(s.tests.incomplete) + ".");
  }
  if (s.tests.planned.tests.empty()) {
    document.paragraph("No test was planned.");
  }
  for (const SideTest& test : s.tests.planned.tests) {
    document.paragraph(sentence(s, test, what));
  }
  add_family(document, s.tests.planned, "Planned test");
  if (s.tests.sequential) {
    add_looks(document, *s.tests.sequential);
  }
  for (const TestFamily& family : s.tests.families) {
    add_family(document, family, capitalized(family.name) + " (two-tailed)");
  }
  document.paragraph(
      "If the same participants had both conditions, tests are paired and the effect size is d_z; "
      "if "
      "they are different participants, the test is Welch's and the effect size Cohen's d. Ranks: "
      "Wilcoxon's signed-rank test (V) or the Mann–Whitney test "
      "(U). Adjusted p values of a column are adjusted together. Bootstrap intervals "
      "are "
      "printed for 30 participants or more: with fewer they are too narrow.");
}

namespace {

void add_published(Document& document, const StudyStatistics& s) {
  document.subheading("As published (Morris 2006, §4.4): pooled trials");
  document.paragraph(
      "These tests assume that all trials are independent. Trials of one participant, and of one "
      "block, are not: differences between participants and blocks then pass for effects of the "
      "condition, and p values are too small. They are here for comparison with the source.");
  document.paragraph(
      "One-way analysis of variance over all trials: " + anova_result(s.anova) +
      (s.eta ? fmt::format(", 90 % CI {} to {}", number(s.eta->low), number(s.eta->high)) : "") +
      ". On ranks (Kruskal–Wallis): " + rank_result(s.ranks) + ".");
  Rows rows;
  for (const auto& c : s.comparisons) {
    rows.push_back({text_of(c.sides), t_result(c.student), t_result(c.welch), effect(c.d)});
  }
  if (!rows.empty()) {
    document.table({"Planned test, pooled trials", "Student", "Welch", "Cohen's d"}, rows);
  }
  document.paragraph(fmt::format(
      "Equal variances, Levene's test about the medians: {}; normal residuals, Shapiro and Wilk's "
      "test: {}. A small p speaks against the assumption; with many trials even small departures "
      "give a small p.",
      levene_result(s.levene), normality_result(s.normality)));
}

}  // namespace

void add_tests(Document& document, const StudyResult& study) {
  document.heading("Analyses");
  add_participants(document, study.statistics, "Recall error");
  add_mixed(document, study.statistics);
  add_published(document, study.statistics);
}

namespace {

std::string tested(const Coefficient& c) {
  return fmt::format("t({:.1f}) = {:.2f}, {}", c.df, c.t, p_value(c.p));
}

std::string tested(const Defined<JointTest>& test) {
  if (!test) {
    return "not defined, because " + test.because();
  }
  return fmt::format("F({:.0f}, {:.1f}) = {:.2f}, {}", test->df_numerator, test->df_denominator,
                     test->f, p_value(test->p));
}

std::vector<std::string> model_row(const std::string& effect, const Coefficient& c) {
  return {effect, number(c.estimate), fmt::format("{} to {}", number(c.low), number(c.high)),
          tested(c)};
}

std::string sphericity_verdict(const RepeatedAnova& anova) {
  constexpr double kAlpha = 0.05;
  const auto& mauchly = anova.sphericity.mauchly;
  if (!mauchly) {
    return "Whether they do could not be tested; trust the tests above.";
  }
  return mauchly->p < kAlpha
             ? "Mauchly's test above says that they do not, so the p values of this model are not "
               "to be trusted; take those of the tests above."
             : "Mauchly's test above does not speak against it.";
}

void add_terms(Document& document, const StudyMixed& study) {
  Rows rows;
  for (std::size_t k = 0; k < study.terms.size(); ++k) {
    const StudyTerm& term = study.terms[k];
    rows.push_back({capitalized(term.words), term.notation, std::to_string(term.groups),
                    number(std::sqrt(study.model->variances[k]))});
  }
  rows.push_back({"Trial (residual)", "", std::to_string(study.model->observations),
                  number(std::sqrt(study.model->variance_within))});
  document.table({"Random intercept", "In lme4", "Groups", "Standard deviation"}, rows);
  for (const std::string& sentence : study.left_out) {
    document.paragraph(capitalized(sentence) + ".");
  }
  if (study.model->at_boundary) {
    document.paragraph(
        "A standard deviation of 0 means that those groups differ no more than chance makes them "
        "differ; the tests are those of the model without that term.");
  }
}

void add_model_effects(Document& document, const StudyMixed& study) {
  Rows rows{model_row(study.conditions[0] + " (mean)", study.model->coefficients[0])};
  for (const MixedPair& pair : study.pairs) {
    if (pair.difference) {
      auto row = model_row(pair.a + " − " + pair.b, *pair.difference);
      row.push_back(pair.holm ? p_value(*pair.holm) : "");
      rows.push_back(std::move(row));
    }
  }
  rows[0].push_back("");
  document.table({"Effect", "Estimate", "95 % CI", "Test (Satterthwaite)", "After Holm"}, rows);
}

}  // namespace

void add_mixed(Document& document, const StudyStatistics& statistics) {
  document.subheading("Mixed model: every trial");
  const StudyMixed& study = statistics.mixed;
  if (!study.model) {
    document.paragraph("Not defined, because " + study.model.because() + ".");
    return;
  }
  document.paragraph(fmt::format(
      "A linear mixed model of recall error by condition over {}, fitted by restricted maximum "
      "likelihood. Random intercepts allow for trials that resemble each other because they share "
      "a participant, a condition of that participant or a block. Participants with missing trials "
      "are kept. Do the conditions differ? {}.",
      counted(study.model->observations, "trial"), tested(study.omnibus)));
  if (statistics.repeated && statistics.table.factors.size() == 1 &&
      statistics.conditions.size() > 2) {
    document.paragraph(
        "The model takes the differences between any two conditions to vary alike "
        "(sphericity). " +
        sphericity_verdict(*statistics.repeated));
  }
  add_model_effects(document, study);
  add_terms(document, study);
}

}  // namespace haptrial::analysis
