#include "analysis/study_statistics.h"

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <tuple>

#include "analysis/p_adjust.h"

namespace haptrial::analysis {
namespace {

using Values = std::vector<double>;

constexpr std::array<const char*, 3> kKnownConditions{"haptic", "visual", "visuohaptic"};

// The planned comparisons: the first is expected to have the lower error.
constexpr std::array<std::pair<const char*, const char*>, 2> kHypotheses{
    {{"visual", "haptic"}, {"visuohaptic", "visual"}}};

std::vector<std::string> ordered_conditions(std::span<const TrialScore> scores) {
  std::set<std::string> found;
  for (const auto& score : scores) {
    found.insert(score.condition);
  }
  std::vector<std::string> result;
  for (const char* known : kKnownConditions) {
    if (found.erase(known) > 0) {
      result.push_back(known);
    }
  }
  result.insert(result.end(), found.begin(), found.end());
  return result;
}

std::vector<std::string> ordered_subjects(std::span<const TrialScore> scores) {
  std::set<std::string> found;
  for (const auto& score : scores) {
    found.insert(score.subject);
  }
  return {found.begin(), found.end()};
}

template <class Predicate>
Values scores_where(std::span<const TrialScore> scores, Predicate&& wanted) {
  Values result;
  for (const auto& score : scores) {
    if (wanted(score)) {
      result.push_back(score.score);
    }
  }
  return result;
}

Values of_condition(std::span<const TrialScore> scores, const std::string& condition) {
  return scores_where(scores, [&](const auto& s) { return s.condition == condition; });
}

// Means of the values by subject, in order of subject.
template <class Predicate>
Values subject_means(std::span<const TrialScore> scores, Predicate&& wanted) {
  std::map<std::string, Values> by_subject;
  for (const auto& score : scores) {
    if (wanted(score)) {
      by_subject[score.subject].push_back(score.score);
    }
  }
  Values means;
  for (const auto& [subject, values] : by_subject) {
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
  return {condition, values.size(), mean_of(values), mean_interval(values),
          mean_interval(
              subject_means(scores, [&](const auto& s) { return s.condition == condition; }))};
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
      study.incomplete.push_back(subject);
      continue;
    }
    const auto [low, high] = std::minmax_element(means.begin(), means.end());
    study.table_1.push_back(
        {subject, means, names_at(study, means, *low), names_at(study, means, *high)});
  }
}

Values table_column(const StudyStatistics& study, const std::string& condition) {
  const auto place = std::find(study.conditions.begin(), study.conditions.end(), condition);
  const auto column = static_cast<std::size_t>(place - study.conditions.begin());
  Values result;
  for (const auto& row : study.table_1) {
    result.push_back(row.means[column]);
  }
  return result;
}

void add_comparisons(StudyStatistics& study, std::span<const TrialScore> scores) {
  const auto has = [&](const char* name) {
    return std::find(study.conditions.begin(), study.conditions.end(), name) !=
           study.conditions.end();
  };
  Values p_values;
  for (const auto& [better, worse] : kHypotheses) {
    Comparison comparison{better, worse};
    if (has(better) && has(worse)) {
      const Values low = of_condition(scores, better);
      const Values high = of_condition(scores, worse);
      comparison.pooled = student_t_test(low, high, Tail::kLess);
      comparison.welch = welch_t_test(low, high, Tail::kLess);
      comparison.paired =
          paired_t_test(table_column(study, better), table_column(study, worse), Tail::kLess);
    }
    if (comparison.paired) {
      p_values.push_back(comparison.paired->p);
    }
    study.comparisons.push_back(std::move(comparison));
  }
  const Values adjusted = holm_adjusted(p_values);
  auto next = adjusted.begin();
  for (auto& comparison : study.comparisons) {
    comparison.paired_holm =
        comparison.paired ? Defined<double>(*next++) : Undefined{comparison.paired.because()};
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

}  // namespace

StudyStatistics study_statistics(std::span<const TrialScore> scores) {
  StudyStatistics study;
  study.subjects = ordered_subjects(scores);
  study.conditions = ordered_conditions(scores);
  std::vector<Values> groups;
  for (const auto& condition : study.conditions) {
    study.summaries.push_back(summarize(scores, condition));
    groups.push_back(of_condition(scores, condition));
  }
  study.anova = one_way_anova(groups);
  add_table_1(study, scores);
  std::vector<Values> table;
  for (const auto& row : study.table_1) {
    table.push_back(row.means);
  }
  study.repeated = repeated_measures_anova(table);
  add_comparisons(study, scores);
  add_learning(study, scores);
  return study;
}

}  // namespace haptrial::analysis
