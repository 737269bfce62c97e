#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/force_training/score/trial_score.h"

namespace haptrial::analysis {

/// A tidy table (RFC 4180 with LF): a heading and a row for every trial, in the order given.
/// Numbers are the shortest decimals that read back to the same double, and empty where not known;
/// equal input gives equal bytes.
/// @param factors  of the study; with several, a column for the level of each follows `condition`.
std::string scores_csv(std::span<const TrialScore> scores,
                       std::span<const std::string> factors = {});

/// Content of such a table.
struct ScoresTable {
  std::vector<std::string> factors;  // "condition" when the table has no column for each factor
  std::vector<TrialScore> scores;
};

/// Reads tables with the columns of quality_columns() and older ones without.
/// @param file_name  for messages.
/// @throws InputError with the line of the first thing that scores_csv() does not write.
ScoresTable read_scores_csv(std::string_view text, const std::string& file_name);

}  // namespace haptrial::analysis
