#pragma once

#include "protocols/force_training/trajectory_pass.h"

namespace haptrial::protocols {

/// Visuohaptic training (V+H): the plane holds the hand, which presses against it; a blue bar shows
/// the target force and a green bar the applied force, to be matched. Source: Morris 2006, §4.2.4.
class VisuohapticTraining final : public TrajectoryPass {
 public:
  using TrajectoryPass::TrajectoryPass;

 private:
  void present(stimulus::Presentation& presentation) const noexcept override;
};

}  // namespace haptrial::protocols
