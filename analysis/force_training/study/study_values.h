#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "analysis/force_training/score/trial_score.h"

namespace haptrial::analysis {

/// Scores picked out of a study's, for its statistics.
using Values = std::vector<double>;

/// The scores of which `wanted` holds, in the order given.
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

inline Values of_condition(std::span<const TrialScore> scores, const std::string& condition) {
  return scores_where(scores, [&](const auto& s) { return s.condition == condition; });
}

/// The same by subject, in order of name.
template <class Predicate>
std::map<std::string, Values> by_subject_where(std::span<const TrialScore> scores,
                                               Predicate&& wanted) {
  std::map<std::string, Values> result;
  for (const auto& score : scores) {
    if (wanted(score)) {
      result[score.subject].push_back(score.score);
    }
  }
  return result;
}

}  // namespace haptrial::analysis
