// How often each test of a report on trials is below 0.05 when conditions do not differ and nobody
// drifts or repeats answers: studies of 12 people at the level of answers. Prints the table of
// docs/algorithms/trials-analysis.md.
//   bench_null_trials [STUDIES] [SEED] [THREADS] [PERMUTATIONS] [TASK 0 to 8; all if left out]
#include <fmt/format.h>

#include <cstdlib>

#include "tests/analysis/psychophysics/study/null_cues.h"
#include "tests/analysis/psychophysics/study/null_trials.h"
#include "tests/analysis/psychophysics/study/simulated_reaches.h"

namespace {

void print(const char* study, const std::string& test, std::size_t found, std::size_t of) {
  const auto band = haptrial::test::binomial_band(of, 0.95);
  const char* where = found > band.high ? "ABOVE" : found < band.low ? "below" : "inside";
  fmt::print("| {} | {} | {} of {} | {} |\n", study, test, found, of, where);
}

/// People who combine two cues with the least variance, but for the last test: the better one
/// alone.
void print_cues(std::size_t studies, std::uint64_t seed, int threads) {
  using haptrial::test::CueUse;
  const auto best = null_cues(CueUse::kLeastVariance, studies, 100000 * seed, threads);
  const auto alone = null_cues(CueUse::kBetterAlone, studies, 100000 * seed, threads);
  for (const auto& test : {best.tests[0], best.tests[1], alone.tests[2]}) {
    print("two cues", test.name, test.found, test.replications);
    fmt::print("  mean difference {:.4f}, standard error {:.4f}\n", test.mean, test.error);
  }
}

}  // namespace

int main(int argc, char** argv) {
  using haptrial::test::SimulatedTask;
  const auto studies = static_cast<std::size_t>(argc > 1 ? std::atoi(argv[1]) : 1000);
  const auto seed = static_cast<std::uint64_t>(argc > 2 ? std::atoll(argv[2]) : 1);
  const int threads = argc > 3 ? std::atoi(argv[3]) : 2;
  const auto permutations = static_cast<std::size_t>(argc > 4 ? std::atoi(argv[4]) : 0);
  const int only = argc > 5 ? std::atoi(argv[5]) : -1;
  for (const SimulatedTask task :
       {SimulatedTask::kStaircase, SimulatedTask::kConstant, SimulatedTask::kComparison,
        SimulatedTask::kDetection, SimulatedTask::kMagnitude, SimulatedTask::kIdentification,
        SimulatedTask::kTimes}) {
    const int number = task == SimulatedTask::kIdentification ? 7
                       : task == SimulatedTask::kTimes        ? 8
                                                              : static_cast<int>(task);
    if (only >= 0 && only != number) {
      continue;
    }
    for (const auto& level :
         haptrial::test::null_trials(task, studies, seed, threads, permutations)) {
      print(name_of(task), level.test, level.found, level.replications);
    }
    std::fflush(stdout);
  }
  if (only < 0 || only == 6) {
    for (const std::vector<std::string>& by :
         {std::vector<std::string>{"group"}, {"block"}, {"group", "block"}}) {
      for (const auto& level : haptrial::test::null_reaches(by, studies, seed, threads)) {
        print(by.size() > 1      ? "reaches, groups and blocks"
              : by[0] == "group" ? "reaches, groups"
                                 : "reaches, blocks",
              level.test, level.found, level.replications);
      }
      std::fflush(stdout);
    }
  }
  if (only < 0 || only == 5) {
    print_cues(studies, seed, threads);
  }
  return 0;
}
