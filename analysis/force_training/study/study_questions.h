#pragma once

#include <string>
#include <vector>

#include "analysis/statistics/base/resampling.h"
#include "analysis/statistics/design/analysis_plan.h"

namespace haptrial::analysis {

/// Questions of a study besides its scores.
struct StudyQuestions {
  AnalysisPlan plan{};
  std::vector<std::string> factors{"condition"};  // names, one for each of TrialScore::levels
  Resampling resampling{1, "", 0, 1};             // of permutation tests and bootstrap; 0: none
};

/// Questions of a report: with permutation tests and bootstrap intervals.
StudyQuestions questions_of(const std::vector<std::string>& factors, const AnalysisPlan& plan,
                            int threads);

}  // namespace haptrial::analysis
