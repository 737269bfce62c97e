#pragma once

#include "protocols/force_training/trajectory_pass.h"

namespace haptrial::protocols {

/// Haptic training (H): the device pushes the hand up with the target force, and the participant
/// keeps the device in the plane by opposing it. No picture of the force. Source: Morris 2006,
/// §4.2.4.
class HapticTraining final : public TrajectoryPass {
 public:
  using TrajectoryPass::TrajectoryPass;

 private:
  bool plane_holds() const noexcept override { return false; }
  void present(stimulus::Presentation& presentation) const noexcept override;
};

}  // namespace haptrial::protocols
