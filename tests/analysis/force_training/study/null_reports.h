#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "analysis/force_training/score/trial_score.h"
#include "tests/support/null_levels.h"

namespace haptrial::test {

/// Conditions given at random to the scores of a study, so that no condition has an effect. Every
/// scheme keeps what real scores share: participant, block, repetition.
enum class NullDesign {
  kOverBlocks,     // three conditions within participants, permuted over each one's blocks
  kByParticipant,  // each participant's own conditions, their names permuted
  kBetween,        // three groups of participants
  kMixed,          // two groups of participants, and conditions permuted over blocks
  kTwoWithin,      // two factors of two levels, permuted over each one's blocks
  kTwoBetween,     // two factors of two levels, four groups of participants
};

const char* name_of(NullDesign design);

/// Reports of as many null studies, each with its own random numbers.
/// @param scores  of a study with three conditions and blocks of one condition each
std::vector<NullLevel> null_reports(std::span<const analysis::TrialScore> scores, NullDesign design,
                                    std::size_t replications, std::uint64_t seed, int threads);

}  // namespace haptrial::test
