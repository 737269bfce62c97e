#pragma once

#include "protocols/force_training/trajectory_pass.h"

namespace haptrial::protocols {

/// The test of path and force: the plane still carries the hand, but nothing leads it along the
/// path. When the path vanishes from the screen it is the participant's turn, for as long as the
/// path takes.
class FreeRecall final : public TrajectoryPass {
 public:
  using TrajectoryPass::TrajectoryPass;

 private:
  RunLead run_lead() const noexcept override { return RunLead::kFree; }
  void present(stimulus::Presentation& presentation) const noexcept override;
};

}  // namespace haptrial::protocols
