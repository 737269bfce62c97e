// How often each test of a report on trials is below 0.05 when conditions do not differ and nobody
// drifts or repeats answers: studies of 12 people at the level of answers. Prints the table of
// docs/algorithms/trials-analysis.md.
//   bench_null_trials [STUDIES] [SEED] [THREADS] [PERMUTATIONS] [TASK from 0; all if left out]
#include <fmt/format.h>

#include <cstdlib>

#include "tests/analysis/trials/psychometric/null_trials.h"

int main(int argc, char** argv) {
  using haptrial::test::SimulatedTask;
  const auto studies = static_cast<std::size_t>(argc > 1 ? std::atoi(argv[1]) : 1000);
  const auto seed = static_cast<std::uint64_t>(argc > 2 ? std::atoll(argv[2]) : 1);
  const int threads = argc > 3 ? std::atoi(argv[3]) : 2;
  const auto permutations = static_cast<std::size_t>(argc > 4 ? std::atoi(argv[4]) : 0);
  const int only = argc > 5 ? std::atoi(argv[5]) : -1;
  for (const SimulatedTask task :
       {SimulatedTask::kStaircase, SimulatedTask::kConstant, SimulatedTask::kComparison,
        SimulatedTask::kDetection, SimulatedTask::kMagnitude}) {
    if (only >= 0 && only != static_cast<int>(task)) {
      continue;
    }
    for (const auto& level :
         haptrial::test::null_trials(task, studies, seed, threads, permutations)) {
      const auto band = haptrial::test::binomial_band(level.replications, 0.95);
      const char* where = level.found > band.high  ? "ABOVE"
                          : level.found < band.low ? "below"
                                                   : "inside";
      fmt::print("| {} | {} | {} of {} | {} |\n", name_of(task), level.test, level.found,
                 level.replications, where);
    }
    std::fflush(stdout);
  }
  return 0;
}
