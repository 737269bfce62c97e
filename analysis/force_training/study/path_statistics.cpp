#include "analysis/force_training/study/path_statistics.h"

#include <vector>

#include "analysis/force_training/study/study_statistics.h"

namespace haptrial::analysis {

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

}  // namespace haptrial::analysis
