#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "analysis/study_statistics.h"

namespace haptrial::analysis {

/// What haptrial analyze left of a study: scores.csv and statistics.json of its folder.
struct ScoredStudy {
  std::string name;  // of its definition
  bool simulated{false};
  bool own_pace{false};  // the participants set the pace, and forces were compared over the path
  std::vector<TrialScore> scores;
};

/// @throws InputError when the folder lacks one of the two, or one is not what analyze writes.
ScoredStudy read_scored_study(const std::filesystem::path& folder);

/// Recall error of one condition in two studies; differences are second minus first.
struct ConditionComparison {
  std::string condition;
  Defined<MeanInterval> first{Undefined{"there are no participants"}};  // of participants' means
  Defined<MeanInterval> second{Undefined{"there are no participants"}};
  Defined<TTest> welch{Undefined{"there are no participants"}};  // of the means, two-sided
  std::size_t shared{0};  // participants of the same identifier with the condition in both
  Defined<TTest> paired{Undefined{"there are no participants"}};        // of theirs, two-sided
  Defined<double> paired_holm{Undefined{"there are no participants"}};  // adjusted over conditions
};

struct StudyComparison {
  ScoredStudy first, second;
  StudyStatistics first_statistics, second_statistics;
  std::vector<ConditionComparison> conditions;  // those that both studies have
};

/// @throws InputError when the studies have no condition in common.
StudyComparison compare_studies(ScoredStudy first, ScoredStudy second);

/// The same in words, in JSON and as one HTML page with its figure.
std::vector<std::string> comparison_lines(const StudyComparison& comparison);
std::string comparison_json(const StudyComparison& comparison);

/// Writes comparison.json, comparison.html and the figure into a folder that exists, over what is
/// there. @throws RunError when that fails.
void write_comparison(const StudyComparison& comparison, const std::filesystem::path& folder);

}  // namespace haptrial::analysis
