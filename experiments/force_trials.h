#pragma once

#include <memory>
#include <optional>

#include "core/stimulus/stimulus.h"
#include "experiments/pass_pictures.h"
#include "experiments/trials.h"
#include "protocols/trajectory_pass.h"

namespace haptrial::experiments {

/// A training pass and a test pass along a path (Morris 2006, §4).
class ForceTrials final : public Trials {
 public:
  ForceTrials(const SessionRequest& request, std::uint64_t session_seed);

  std::vector<protocols::PlannedTrial> plan() const override;
  std::span<const record::Phase> phases() const override;
  std::unique_ptr<Rig> virtual_rig(std::uint64_t session_seed) const override;
  std::vector<stimulus::Observer*> observers() override;
  void prepare(const protocols::PlannedTrial& trial, SessionRecord& record) override;
  void begin_attempt(const protocols::PlannedTrial&, bool) override {}
  void show(Screen& screen) override { screen.show_trial(stimulus_->path.points()); }
  protocols::Pass& make_pass(protocols::PlannedTrial& trial, record::Phase phase,
                             SessionRecord& record) override;
  void close_pass(SessionRecord&, std::int32_t) override {}
  void draw_pictures(const protocols::PlannedTrial& trial, record::Phase phase) override {
    pictures_.draw(trial, phase);
  }
  const char* why_aborted() const override {
    return "the tool did not come to the start, or to the end, in time";
  }

 private:
  const SessionRequest& request_;
  const Definition& d_;
  std::uint64_t session_seed_;
  PassPictures pictures_;
  std::optional<stimulus::Stimulus> stimulus_;
  std::uint64_t stimulus_seed_{0};
  std::unique_ptr<protocols::TrajectoryPass> pass_;
};

}  // namespace haptrial::experiments
