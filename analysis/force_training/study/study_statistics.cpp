#include "analysis/force_training/study/study_statistics.h"

#include <algorithm>
#include <array>
#include <set>

#include "analysis/statistics/relation/regression.h"
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

/// Adds the tests of a study to what study_statistics() has gathered: conditions, subjects, table
/// and table_1 are there.
void add_tests(StudyStatistics& study, std::span<const TrialScore> scores,
               const StudyQuestions& questions) {
  study.tests = design_tests(study.table, questions.plan, questions.resampling);
  add_repeated(study);
  study.mixed = study_mixed(scores, study.conditions);
  add_pooled(study, scores);
  add_pooled_tests(study, scores, questions.plan);
}

constexpr std::array<const char*, 3> kKnownConditions{"haptic", "visual", "visuohaptic"};

/// The reference condition first.
std::vector<std::string> first_conditions(const AnalysisPlan& plan) {
  std::vector<std::string> first;
  if (!plan.reference.empty()) {
    first.push_back(plan.reference);
  }
  first.insert(first.end(), kKnownConditions.begin(), kKnownConditions.end());
  return first;
}

DesignTable table_of(std::span<const TrialScore> scores, const StudyQuestions& questions) {
  std::vector<Observation> observations;
  for (const auto& score : scores) {
    observations.push_back(
        {score.subject,
         score.levels.empty() ? std::vector<std::string>{score.condition} : score.levels,
         score.score});
  }
  return design_table(observations, questions.factors, first_conditions(questions.plan));
}

// Means of the values by subject, in order of subject.
template <class Predicate>
Values subject_means(std::span<const TrialScore> scores, Predicate&& wanted) {
  Values means;
  for (const auto& [subject, values] : by_subject_where(scores, wanted)) {
    if (const auto m = moments(values)) {
      means.push_back(m->mean());
    }
  }
  return means;
}

Defined<double> mean_of(const Values& values) {
  const auto m = moments(values);
  return m ? Defined<double>(m->mean()) : Undefined{m.because()};
}

ConditionSummary summarize(std::span<const TrialScore> scores, const std::string& condition) {
  const Values values = of_condition(scores, condition);
  const Values means =
      subject_means(scores, [&](const auto& s) { return s.condition == condition; });
  return {condition,       values.size(),         means.size(),
          mean_of(values), mean_interval(values), mean_interval(means)};
}

std::string names_at(const StudyStatistics& study, const Values& means, double value) {
  std::string names;
  for (std::size_t c = 0; c < means.size(); ++c) {
    if (means[c] == value) {
      names += (names.empty() ? "" : " and ") + study.conditions[c];
    }
  }
  return names;
}

void add_table_1(StudyStatistics& study, std::span<const TrialScore> scores) {
  for (const auto& subject : study.subjects) {
    Values means;
    for (const auto& condition : study.conditions) {
      const auto m = moments(scores_where(
          scores, [&](const auto& s) { return s.subject == subject && s.condition == condition; }));
      if (m) {
        means.push_back(m->mean());
      }
    }
    if (means.size() < study.conditions.size()) {
      continue;
    }
    const auto [low, high] = std::minmax_element(means.begin(), means.end());
    study.table_1.push_back(
        {subject, means, names_at(study, means, *low), names_at(study, means, *high)});
  }
}

void add_learning(StudyStatistics& study, std::span<const TrialScore> scores) {
  for (const auto& condition : study.conditions) {
    std::set<std::int32_t> repetitions;
    for (const auto& score : scores) {
      if (score.condition == condition) {
        repetitions.insert(score.repetition);
      }
    }
    for (const auto repetition : repetitions) {
      const Values means = subject_means(scores, [&](const auto& s) {
        return s.condition == condition && s.repetition == repetition;
      });
      study.learning.push_back(
          {condition, repetition, means.size(), mean_of(means), mean_interval(means)});
    }
  }
}

/// How the error of one participant changes from block to block.
Defined<double> slope_of(std::span<const TrialScore> scores, const std::string& subject) {
  Values blocks;
  Values errors;
  for (const auto& score : scores) {
    if (score.subject == subject) {
      blocks.push_back(score.block);
      errors.push_back(score.score);
    }
  }
  const auto fit = linear_regression(blocks, errors);
  return fit ? Defined<double>(fit->coefficients[1].estimate) : Undefined{fit.because()};
}

void add_blocks(StudyStatistics& study, std::span<const TrialScore> scores) {
  std::set<std::int32_t> blocks;
  for (const auto& score : scores) {
    blocks.insert(score.block);
  }
  for (const auto block : blocks) {
    const Values means = subject_means(scores, [&](const auto& s) { return s.block == block; });
    study.blocks.push_back({block, means.size(), mean_of(means), mean_interval(means)});
  }
  Values slopes;
  for (const auto& subject : study.subjects) {
    if (const auto slope = slope_of(scores, subject)) {
      slopes.push_back(*slope);
    }
  }
  study.slope = mean_interval(slopes);
}

}  // namespace

StudyStatistics study_statistics(std::span<const TrialScore> scores,
                                 const StudyQuestions& questions) {
  StudyStatistics study;
  study.table = table_of(scores, questions);
  study.subjects = study.table.subjects;
  study.conditions = study.table.names;
  for (const auto& condition : study.conditions) {
    study.summaries.push_back(summarize(scores, condition));
  }
  add_table_1(study, scores);
  add_tests(study, scores, questions);
  add_learning(study, scores);
  add_blocks(study, scores);
  return study;
}

std::optional<StudyStatistics> path_statistics(std::span<const TrialScore> scores,
                                               const StudyQuestions& questions) {
  constexpr double kMillimetre = 1e-3;  // [m]
  std::vector<TrialScore> paths;
  for (const TrialScore& score : scores) {
    if (score.path_error) {
      paths.push_back(score);
      paths.back().score = *score.path_error / kMillimetre;
    }
  }
  return paths.empty() ? std::nullopt : std::optional(study_statistics(paths, questions));
}

StudyQuestions questions_of(const std::vector<std::string>& factors, const AnalysisPlan& plan,
                            int threads) {
  StudyQuestions questions{plan, factors};
  questions.resampling.count = 9999;
  questions.resampling.threads = threads;
  return questions;
}

}  // namespace haptrial::analysis
