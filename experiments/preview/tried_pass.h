#pragma once

#include <memory>

#include "core/device/mouse.h"
#include "experiments/preview/tried_trial.h"
#include "protocols/interface/pass.h"

namespace haptrial::experiments {

/// A trial of passes under a pointer: the pass of a session, driven by the device "mouse". When a
/// pass is over, nothing is felt until another begins.
class TriedPass : public TriedTrial {
 public:
  double rate() const final { return rate_; }
  Eigen::Vector3d start() const final { return start_; }
  double reach() const final { return mouse_.info().workspace_radius; }
  Moment tick(const Eigen::Vector3d& pointer) final;

 protected:
  /// @param definition  outlives the trial  @param start  of the hand, in W [m]
  TriedPass(const protocols::Definition& definition, const Eigen::Vector3d& start);
  void begin(std::unique_ptr<protocols::Pass> pass);
  /// Holds buttons of the device from the next tick on. @param buttons  a bit each
  void hold(std::uint32_t buttons) noexcept { buttons_ = buttons; }
  bool is_over() const noexcept { return pass_->state() != protocols::PassState::kRunning; }
  /// Output of the last tick.
  const protocols::PassOutput& output() const noexcept { return output_; }
  /// Called before each tick, such as for buttons that go down and up again.
  virtual void before_tick() {}

 private:
  double rate_;
  Eigen::Vector3d start_;
  device::MouseDevice mouse_;
  std::unique_ptr<protocols::Pass> pass_;
  std::uint32_t buttons_{0};
  protocols::PassOutput output_;
};

}  // namespace haptrial::experiments
