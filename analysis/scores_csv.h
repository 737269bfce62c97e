#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/trial_score.h"

namespace haptrial::analysis {

/// A tidy table (RFC 4180 with LF): a heading and a row for every trial, in the order given.
/// Numbers are the shortest decimals that read back to the same double; equal input gives equal
/// bytes.
std::string scores_csv(std::span<const TrialScore> scores);

/// The scores of such a table. @param file_name  for messages.
/// @throws InputError with the line of the first thing that scores_csv() does not write.
std::vector<TrialScore> read_scores_csv(std::string_view text, const std::string& file_name);

}  // namespace haptrial::analysis
