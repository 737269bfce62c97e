#pragma once

#include <cstdint>

#include "analysis/statistics/base/defined.h"

namespace haptrial::analysis {

/// The question about the stimuli of a trial. The d' of each task is that of an observer without
/// bias.
enum class DiscriminationTask : std::uint8_t {
  kForcedChoice,   // which of m stimuli it was: forced_choice_share()
  kOneInterval,    // which of two stimuli was presented alone: d' is the distance between them
  kOddity,         // which of three differs from the two others, by their differences
  kAbx,            // whether the third is as the first or as the second, by their differences
  kSameDifferent,  // whether two are the same, from independent observations
};

/// Share of right answers.
/// @param d_prime       at least 0 except in a forced choice and one interval
/// @param alternatives  of a forced choice, 2 to 1000
/// Source: Macmillan and Creelman 2005, Detection Theory, chapters 7, 9 and 10.
double task_share(DiscriminationTask task, double d_prime, int alternatives);
/// The d' with a share of right answers; 0 for a share below chance, except in a forced choice and
/// one interval.
/// Undefined unless 0 < share < 1.
Defined<double> task_d_prime(DiscriminationTask task, double share, int alternatives);

}  // namespace haptrial::analysis
