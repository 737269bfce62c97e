#include "protocols/recorded_pass.h"

#include "protocols/recall_test.h"
#include "protocols/training_pass.h"

namespace haptrial::protocols {

std::unique_ptr<TrajectoryPass> make_pass(const std::string& condition, record::Phase phase,
                                          const stimulus::Stimulus& stimulus,
                                          const GuidanceParameters& parameters,
                                          std::int32_t block) {
  if (phase == record::Phase::kTest) {
    return std::make_unique<RecallTest>(stimulus, parameters, block);
  }
  return make_training_pass(condition, stimulus, parameters, block);
}

std::vector<stimulus::Presentation> presentations(const TrajectoryPass& pass,
                                                  std::span<const record::Sample> samples,
                                                  double rate) {
  std::vector<stimulus::Presentation> seen;
  seen.reserve(samples.size());
  double run_time = 0.0;
  bool running = false;
  for (const record::Sample& s : samples) {
    const bool runs = s.stage == record::Stage::kRun;
    run_time = runs && running ? run_time + 1.0 / rate : 0.0;  // the run's first tick is its time 0
    running = runs;
    seen.push_back(pass.presentation(
        {s.position, s.stage, run_time, s.target_force, s.applied_force, s.saturated}));
  }
  return seen;
}

}  // namespace haptrial::protocols
