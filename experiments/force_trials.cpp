#include "experiments/force_trials.h"

#include <array>

#include "experiments/session_record.h"
#include "experiments/virtual_rig.h"
#include "protocols/recorded_pass.h"

namespace haptrial::experiments {

ForceTrials::ForceTrials(const SessionRequest& request, std::uint64_t session_seed)
    : request_(request), d_(*request.definition), session_seed_(session_seed), pictures_(request) {}

std::vector<protocols::PlannedTrial> ForceTrials::plan() const {
  return protocols::plan_trials(d_.design, request_.participant, request_.seed, session_seed_);
}

std::span<const record::Phase> ForceTrials::phases() const {
  static constexpr std::array kPhases{record::Phase::kTraining, record::Phase::kTest};
  return kPhases;
}

std::unique_ptr<Rig> ForceTrials::virtual_rig(std::uint64_t session_seed) const {
  return std::make_unique<VirtualRig>(d_, session_seed);
}

std::vector<stimulus::Observer*> ForceTrials::observers() {
  std::vector<stimulus::Observer*> all;
  if (pictures_.observer() != nullptr) {
    all.push_back(pictures_.observer());
  }
  return all;
}

void ForceTrials::prepare(const protocols::PlannedTrial& trial, SessionRecord& record) {
  if (!stimulus_ || stimulus_seed_ != trial.stimulus_seed) {
    stimulus_ = stimulus::make_stimulus(d_.trajectory, d_.force_pattern, trial.stimulus_seed);
    stimulus_seed_ = trial.stimulus_seed;
    pictures_.set_trajectory(stimulus_->path.points());
  }
  record.keep_stimulus(trial, *stimulus_);
}

protocols::Pass& ForceTrials::make_pass(protocols::PlannedTrial& trial, record::Phase phase,
                                        SessionRecord&) {
  pass_ = protocols::make_pass(trial.condition, phase, *stimulus_, d_.guidance, trial.block);
  return *pass_;
}

}  // namespace haptrial::experiments
