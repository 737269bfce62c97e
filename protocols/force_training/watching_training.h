#pragma once

#include "protocols/force_training/trajectory_pass.h"

namespace haptrial::protocols {

/// Training by watching: the hand rests at the start; the marker moves along the path as the
/// expert's tool does, and a blue bar shows how hard the expert presses.
class WatchingTraining final : public TrajectoryPass {
 public:
  using TrajectoryPass::TrajectoryPass;

 private:
  RunLead run_lead() const noexcept override { return RunLead::kWatched; }
  void present(stimulus::Presentation& presentation) const noexcept override;
};

}  // namespace haptrial::protocols
