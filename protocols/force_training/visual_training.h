#pragma once

#include "protocols/force_training/trajectory_pass.h"

namespace haptrial::protocols {

/// Visual training (V): the plane holds the hand; a blue bar shows the target force.
/// Source: Morris 2006, §4.2.4.
class VisualTraining final : public TrajectoryPass {
 public:
  using TrajectoryPass::TrajectoryPass;

 private:
  void present(stimulus::Presentation& presentation) const noexcept override;
};

}  // namespace haptrial::protocols
