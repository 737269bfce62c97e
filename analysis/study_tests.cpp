#include "analysis/study_tests.h"

#include <algorithm>
#include <array>

#include "analysis/p_adjust.h"
#include "analysis/study_values.h"

namespace haptrial::analysis {
namespace {

// The planned comparisons: the first is expected to have the lower error.
constexpr std::array<std::pair<const char*, const char*>, 2> kHypotheses{
    {{"visual", "haptic"}, {"visuohaptic", "visual"}}};

std::size_t place_of(const StudyStatistics& study, const std::string& condition) {
  const auto place = std::find(study.conditions.begin(), study.conditions.end(), condition);
  return static_cast<std::size_t>(place - study.conditions.begin());
}

Values table_column(const StudyStatistics& study, std::size_t column) {
  Values result;
  for (const auto& row : study.table_1) {
    result.push_back(row.means[column]);
  }
  return result;
}

void add_planned(StudyStatistics& study, std::span<const TrialScore> scores) {
  std::vector<Defined<TTest>> paired;
  for (const auto& [better, worse] : kHypotheses) {
    const std::size_t low = place_of(study, better);
    const std::size_t high = place_of(study, worse);
    if (low >= study.conditions.size() || high >= study.conditions.size()) {
      continue;  // another study: it has its own conditions, compared pair by pair
    }
    Comparison c{better, worse};
    const Values a = of_condition(scores, better);
    const Values b = of_condition(scores, worse);
    c.pooled = student_t_test(a, b, Tail::kLess);
    c.pooled_d = cohens_d(a, b);
    c.welch = welch_t_test(a, b, Tail::kLess);
    c.paired = paired_t_test(table_column(study, low), table_column(study, high), Tail::kLess);
    c.paired_dz = cohens_dz(table_column(study, low), table_column(study, high));
    paired.push_back(c.paired);
    study.comparisons.push_back(std::move(c));
  }
  const auto adjusted = holm_over(paired);
  for (std::size_t i = 0; i < study.comparisons.size(); ++i) {
    study.comparisons[i].paired_holm = adjusted[i];
  }
}

void add_pairs(StudyStatistics& study) {
  std::vector<Defined<TTest>> tests;
  for (std::size_t i = 0; i < study.conditions.size(); ++i) {
    for (std::size_t k = i + 1; k < study.conditions.size(); ++k) {
      const Values a = table_column(study, i);
      const Values b = table_column(study, k);
      PairComparison pair{study.conditions[i], study.conditions[k]};
      pair.test = paired_t_test(a, b, Tail::kTwoSided);
      pair.dz = cohens_dz(a, b);
      pair.signed_rank = wilcoxon_signed_rank(a, b, Tail::kTwoSided);
      tests.push_back(pair.test);
      study.pairs.push_back(std::move(pair));
    }
  }
  const auto adjusted = holm_over(tests);
  for (std::size_t i = 0; i < study.pairs.size(); ++i) {
    study.pairs[i].holm = adjusted[i];
  }
}

/// What is left of each score when the mean of its condition is taken away.
Values residuals(const std::vector<Values>& groups) {
  Values all;
  for (const Values& group : groups) {
    const auto m = moments(group);
    for (const double value : group) {
      all.push_back(m ? value - m->mean() : 0.0);
    }
  }
  return all;
}

void add_pooled(StudyStatistics& study, std::span<const TrialScore> scores) {
  std::vector<Values> groups;
  for (const auto& condition : study.conditions) {
    groups.push_back(of_condition(scores, condition));
  }
  study.anova = one_way_anova(groups);
  if (study.anova) {
    study.eta = eta_squared(*study.anova);
  } else {
    study.eta = Undefined{study.anova.because()};
  }
  study.ranks = kruskal_wallis(groups);
  study.levene = levene(groups, Centre::kMedian);
  study.normality = shapiro_wilk(residuals(groups));
}

void add_repeated(StudyStatistics& study) {
  std::vector<Values> table;
  for (const auto& row : study.table_1) {
    table.push_back(row.means);
  }
  study.repeated = repeated_measures_anova(table);
  study.friedman = friedman(table);
  if (!study.repeated) {
    study.partial_eta = Undefined{study.repeated.because()};
    study.generalized_eta = Undefined{study.repeated.because()};
    return;
  }
  const RepeatedAnova& r = *study.repeated;
  study.partial_eta = partial_eta_squared(r.f, r.df_condition, r.df_error);
  study.generalized_eta =
      generalized_eta_squared(r.squares_condition, r.squares_participants + r.squares_error);
}

}  // namespace

void add_tests(StudyStatistics& study, std::span<const TrialScore> scores) {
  add_pooled(study, scores);
  add_repeated(study);
  add_planned(study, scores);
  add_pairs(study);
  study.mixed = study_mixed(scores, study.conditions);
}

}  // namespace haptrial::analysis
