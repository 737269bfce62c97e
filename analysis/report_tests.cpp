#include <fmt/format.h>

#include "analysis/report_parts.h"
#include "analysis/wording.h"

namespace haptrial::analysis {
namespace {

using Rows = std::vector<std::vector<std::string>>;

std::string holm(const Defined<double>& p) {
  return p ? p_value(*p) : "not defined, because " + p.because();
}

const ConditionSummary& summary_of(const StudyStatistics& s, const std::string& condition) {
  const auto found = std::find_if(s.summaries.begin(), s.summaries.end(),
                                  [&](const auto& each) { return each.condition == condition; });
  return *found;
}

/// As journals want a planned test, in one sentence.
std::string sentence(const StudyStatistics& s, const Comparison& c) {
  constexpr double kAlpha = 0.05;
  if (!c.pooled) {
    return fmt::format(
        "Whether error was lower after {} than after {} training is not defined, "
        "because {}.",
        c.better, c.worse, c.pooled.because());
  }
  const auto mean = [&](const std::string& condition) {
    const auto& summary = summary_of(s, condition);
    return fmt::format("M = {}, SD = {}", number(*summary.mean),
                       summary.trials ? number(summary.trials->deviation) : "-");
  };
  return fmt::format(
      "Recall error was {} after {} ({}) than after {} training ({}), {}, one-tailed, d = {}.",
      c.pooled->p < kAlpha ? "significantly lower" : "not significantly lower", c.better,
      mean(c.better), c.worse, mean(c.worse), t_result(c.pooled), effect(c.pooled_d));
}

void add_published(Document& document, const StudyStatistics& s) {
  document.subheading("As published: pooled trials");
  document.paragraph(
      "One-way analysis of variance over all trials: " + anova_result(s.anova) +
      (s.eta ? fmt::format(", 90 % CI {} to {}", number(s.eta->low), number(s.eta->high)) : "") +
      ". On ranks (Kruskal and Wallis): " + rank_result(s.ranks) + ".");
  Rows rows;
  for (const auto& c : s.comparisons) {
    document.paragraph(sentence(s, c));
    rows.push_back(
        {c.better + " < " + c.worse, t_result(c.pooled), t_result(c.welch), effect(c.pooled_d)});
  }
  if (!rows.empty()) {
    document.table({"Hypothesis (one-tailed)", "Student", "Welch", "Cohen's d"}, rows);
  }
  document.paragraph(
      fmt::format("Assumptions: equal variances, Levene's test about the medians: {}; normal "
                  "residuals, Shapiro "
                  "and Wilk's: {}. Small p speak against them; with many trials small departures "
                  "are found too.",
                  levene_result(s.levene), normality_result(s.normality)));
}

void add_repeated(Document& document, const StudyStatistics& s) {
  document.subheading("Repeated measures: participants' means");
  document.paragraph(
      "The trials of one participant are not independent, so the pooled tests count more evidence "
      "than there is; here every participant gives one mean for each condition, and conditions are "
      "compared within participants.");
  document.paragraph(
      "One-way repeated-measures analysis of variance: " + anova_result(s.repeated) +
      (s.partial_eta ? fmt::format(", 90 % CI {} to {}", number(s.partial_eta->low),
                                   number(s.partial_eta->high))
                     : "") +
      (s.generalized_eta ? fmt::format("; generalized η² = {:.2g}", *s.generalized_eta) : "") +
      ". " + sphericity_result(s.repeated) + " On ranks (Friedman): " + rank_result(s.friedman) +
      ".");
  if (!s.incomplete.empty()) {
    document.paragraph(
        "Left out for lack of a scored trial in some condition: " + joined(s.incomplete) + ".");
  }
  Rows rows;
  for (const auto& c : s.comparisons) {
    rows.push_back(
        {c.better + " < " + c.worse, t_result(c.paired), holm(c.paired_holm), effect(c.paired_dz)});
  }
  if (!rows.empty()) {
    document.table({"Hypothesis (one-tailed)", "Paired t-test", "After Holm", "d_z"}, rows);
  }
  rows.clear();
  for (const auto& pair : s.pairs) {
    rows.push_back({pair.a + " and " + pair.b, t_result(pair.test), holm(pair.holm),
                    effect(pair.dz), rank_result(pair.signed_rank)});
  }
  if (!rows.empty()) {
    document.table(
        {"Every two conditions (two-tailed)", "Paired t-test", "After Holm", "d_z", "Wilcoxon"},
        rows);
  }
}

}  // namespace

void add_tests(Document& document, const StudyResult& study) {
  document.heading("Analyses");
  add_published(document, study.statistics);
  add_repeated(document, study.statistics);
  add_mixed(document, study.statistics);
}

}  // namespace haptrial::analysis
