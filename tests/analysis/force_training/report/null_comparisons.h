#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "analysis/force_training/score/trial_score.h"
#include "tests/support/null_levels.h"

namespace haptrial::test {

/// How one study becomes two that do not differ.
enum class NullSplit {
  kBlocks,        // each participant's blocks of a condition, half to each: the same people in both
  kParticipants,  // half of the participants to each
};

const char* name_of(NullSplit split);

/// The tests of as many comparisons of two such studies.
std::vector<NullLevel> null_comparisons(std::span<const analysis::TrialScore> scores,
                                        NullSplit split, std::size_t replications,
                                        std::uint64_t seed, int threads);

}  // namespace haptrial::test
