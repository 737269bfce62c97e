#include "tests/analysis/psychophysics/study/null_trials.h"

#include <fmt/format.h>

#include "analysis/psychophysics/study/trials_study.h"
#include "core/base/random.h"

namespace haptrial::test {

const char* name_of(SimulatedTask task) {
  switch (task) {
    case SimulatedTask::kStaircase:
      return "two intervals, staircases";
    case SimulatedTask::kConstant:
      return "two intervals, constant stimuli";
    case SimulatedTask::kComparison:
      return "larger or smaller, constant stimuli";
    case SimulatedTask::kDetection:
      return "yes or no with ratings";
    case SimulatedTask::kIdentification:
      return "which of four, with ratings";
    case SimulatedTask::kTimes:
      return "speeded choices";
    case SimulatedTask::kMagnitude:
      break;
  }
  return "magnitude estimation";
}

namespace {

NullLevels one_study(SimulatedTask task, std::uint64_t seed, std::size_t number,
                     std::size_t permutations) {
  SimulatedTrials study;
  study.task = task;
  study.trials = task == SimulatedTask::kMagnitude        ? 25
                 : task == SimulatedTask::kIdentification ? 48
                 : task == SimulatedTask::kTimes          ? 40
                                                          : 120;
  if (task == SimulatedTask::kComparison) {
    study.spread = 0.6;
    study.interaction = 0.3;
  }
  study.seed = derived_seed(seed, fmt::format("null trials {} {}", name_of(task), number));
  analysis::trials::TrialsPlan plan = plan_of(study);
  plan.permutations = permutations;
  plan.plan = analysis::parse_analysis_plan({"off < on"}, "", "tests");
  NullLevels levels;
  const auto result = analysis::trials::analyze(simulated_trials(study), plan, {}, 1);
  for (const auto& test : analysis::trials::tests_of(result)) {
    levels.note(test.name, true, test.p < 0.05);
  }
  return levels;
}

}  // namespace

std::vector<NullLevel> null_study(SimulatedTask task, std::uint64_t seed, std::size_t number) {
  return one_study(task, seed, number, 0).all();
}

std::vector<NullLevel> null_trials(SimulatedTask task, std::size_t replications, std::uint64_t seed,
                                   int threads, std::size_t permutations) {
  return null_levels(replications, threads, [&](std::size_t number) {
    return one_study(task, seed, number, permutations);
  });
}

}  // namespace haptrial::test
