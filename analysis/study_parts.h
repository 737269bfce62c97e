#pragma once

#include <string>
#include <utility>
#include <vector>

#include "analysis/score.h"
#include "analysis/study.h"

namespace haptrial::analysis {

// What a study of session files and one of curves from elsewhere have in common.

/// The places of the best, the median (the lower of two) and the worst of the scores, with those
/// words; of equal scores the first. None without scores.
std::vector<std::pair<std::string, std::size_t>> notable(const std::vector<TrialScore>& scores);

/// @param which  "best", "median" or "worst"
RecallPicture recall_picture(const std::string& which, const TrialScore& score,
                             RecallDetail detail);

}  // namespace haptrial::analysis
