#include "analysis/force_training/study/study_tests.h"

#include "analysis/force_training/study/study_values.h"
#include "analysis/statistics/variance/effect_size.h"

namespace haptrial::analysis {
namespace {

/// The planned tests of conditions as the source made them.
void add_pooled_tests(StudyStatistics& study, std::span<const TrialScore> scores,
                      const AnalysisPlan& plan) {
  for (const PlannedTest& sides : plan.tests) {
    const Values a = of_condition(scores, sides.a);
    const Values b = of_condition(scores, sides.b);
    if (a.empty() || b.empty()) {
      continue;  // a level of several conditions, or one without trials
    }
    study.comparisons.push_back(
        {sides, student_t_test(a, b, sides.tail), welch_t_test(a, b, sides.tail), cohens_d(a, b)});
  }
}

/// Each score less the mean of its condition.
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

void add_tests(StudyStatistics& study, std::span<const TrialScore> scores,
               const StudyQuestions& questions) {
  study.tests = design_tests(study.table, questions.plan, questions.resampling);
  add_repeated(study);
  study.mixed = study_mixed(scores, study.conditions);
  add_pooled(study, scores);
  add_pooled_tests(study, scores, questions.plan);
}

}  // namespace haptrial::analysis
