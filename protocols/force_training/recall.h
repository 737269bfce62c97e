#pragma once

#include "protocols/force_training/trajectory_pass.h"

namespace haptrial::protocols {

/// The test (T) after every training: the plane holds the hand, the participant applies the learnt
/// force. No picture of the force. Source: Morris 2006, §4.2.4.
class RecallTest final : public TrajectoryPass {
 public:
  using TrajectoryPass::TrajectoryPass;

 private:
  void present(stimulus::Presentation& presentation) const noexcept override;
};

}  // namespace haptrial::protocols
