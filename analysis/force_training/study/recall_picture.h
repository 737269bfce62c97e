#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "analysis/force_training/score/score.h"
#include "analysis/force_training/score/trial_score.h"

namespace haptrial::analysis {

/// How one recall was aligned with its target, on the common time base.
/// Source: Morris 2006, §4.3, Figures 26 and 27.
struct RecallPicture {
  std::string which;  // "best", "median" or "worst" of the study
  TrialScore score;
  double duration{0.0};                                      // of the pass [s]
  std::vector<double> target{};                              // (base) [N]
  std::vector<double> applied{};                             // (base) filtered [N]
  std::vector<double> warped{};                              // (base) applied after alignment [N]
  std::vector<std::pair<std::size_t, std::size_t>> pairs{};  // (path) target index, applied index
};

/// The places of the best, the median (the lower of two) and the worst of the scores, with those
/// words; of equal scores the first. None without scores.
std::vector<std::pair<std::string, std::size_t>> notable(const std::vector<TrialScore>& scores);

/// @param which  "best", "median" or "worst"
RecallPicture recall_picture(const std::string& which, const TrialScore& score,
                             RecallDetail detail);

}  // namespace haptrial::analysis
