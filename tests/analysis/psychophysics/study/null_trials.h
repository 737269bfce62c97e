#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "tests/analysis/psychophysics/simulated_trials.h"
#include "tests/support/null_levels.h"

namespace haptrial::test {

const char* name_of(SimulatedTask task);

/// Reports of as many studies of 12 people whose conditions do not differ, who do not drift and do
/// not repeat themselves, each with its own random numbers: how often each test is below 0.05.
/// @param permutations  of each permutation test
std::vector<NullLevel> null_trials(SimulatedTask task, std::size_t replications, std::uint64_t seed,
                                   int threads, std::size_t permutations = 0);

/// One of these studies alone. @param number  from 0
std::vector<NullLevel> null_study(SimulatedTask task, std::uint64_t seed, std::size_t number);

}  // namespace haptrial::test
