#include "analysis/force_training/study/study_statistics.h"

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <tuple>

#include "analysis/force_training/study/study_tests.h"
#include "analysis/force_training/study/study_values.h"
#include "analysis/statistics/relation/regression.h"

namespace haptrial::analysis {
namespace {

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

}  // namespace haptrial::analysis
