#pragma once

#include <span>
#include <string>

#include "analysis/trial_score.h"

namespace haptrial::analysis {

/// A tidy table (RFC 4180 with LF): a heading and a row for every trial, in the order given.
/// Numbers are the shortest decimals that read back to the same double; equal input gives equal
/// bytes.
std::string scores_csv(std::span<const TrialScore> scores);

}  // namespace haptrial::analysis
