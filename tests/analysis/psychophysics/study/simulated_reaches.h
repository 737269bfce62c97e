#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "analysis/psychophysics/fit/reaching_study.h"
#include "analysis/psychophysics/fit/trials_plan.h"
#include "tests/support/null_levels.h"

namespace haptrial::test {

/// Reaches of people who learn nothing, without the loop: errors and times around means of their
/// own, each reach a little like the one before. Every fourth reach is in a channel.
struct SimulatedReaches {
  std::size_t participants{12};      // half of them in group "a", the others in "b"
  std::size_t trials{32};            // of each of the blocks "before", "during" and "after"
  double difference_of_groups{0.0};  // in the error [m]
  double rise_of_blocks{0.0};        // of the error, from one to the next [m]
  std::uint64_t seed{1};
};

struct ReachesOfStudy {
  analysis::trials::TrialsData data;
  analysis::trials::ReachingResult reaching;  // its reaches with persons and blocks, and plan
};

ReachesOfStudy simulated_reaches(const SimulatedReaches& study,
                                 const analysis::trials::ReachingPlan& plan);

/// A plan that compares every quantity between groups and blocks, with a planned test of each.
/// @param by  "group", "block" or both
analysis::trials::TrialsPlan reach_plan(const std::vector<std::string>& by);

/// How often each test of the report on reaches is below 0.05.
std::vector<NullLevel> null_reaches(const std::vector<std::string>& by, std::size_t replications,
                                    std::uint64_t seed, int threads);

}  // namespace haptrial::test
