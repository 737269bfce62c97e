#include "protocols/force_training/recorded_pass.h"

#include "protocols/force_training/training_pass.h"

namespace haptrial::protocols {

std::unique_ptr<TrajectoryPass> make_pass(const std::string& condition, record::Phase phase,
                                          const stimulus::Stimulus& stimulus,
                                          const GuidanceParameters& parameters,
                                          std::int32_t block) {
  if (phase == record::Phase::kTest) {
    return std::make_unique<TrajectoryPass>(parameters.free_recall ? kFreeRecall : kRecallTest,
                                            stimulus, parameters, block);
  }
  return make_training_pass(condition, stimulus, parameters, block);
}

std::vector<stimulus::Presentation> presentations(const TrajectoryPass& pass,
                                                  std::span<const record::Sample> samples,
                                                  double rate,
                                                  std::span<const record::TutoringRow> expert) {
  std::vector<stimulus::Presentation> seen;
  seen.reserve(samples.size());
  double along = 0.0;
  bool running = false;
  std::optional<CurveGuide> guide = pass.curve_guide();
  for (const record::Sample& s : samples) {
    const bool runs = s.stage == record::Stage::kRun;
    along = runs && running ? along + 1.0 / rate : 0.0;  // the run's first tick is its time 0
    running = runs;
    while (!expert.empty() && expert.front().sequence < s.sequence) {
      expert = expert.subspan(1);
    }
    if (!expert.empty() && expert.front().sequence == s.sequence) {
      along = expert.front().time;
    }
    PassMoment moment{s.position, s.stage, along, s.target_force, s.applied_force, s.saturated};
    if (runs && guide) {
      guide->follow({s.position, s.velocity});
      moment.along = guide->along();
      moment.direction = guide->direction();
    }
    seen.push_back(pass.presentation(moment));
  }
  return seen;
}

}  // namespace haptrial::protocols
