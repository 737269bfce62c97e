#include "protocols/force_training/haptic_training.h"

namespace haptrial::protocols {

void HapticTraining::present(stimulus::Presentation& presentation) const noexcept {
  presentation.instruction = stimulus::Instruction::kHoldPlane;
}

}  // namespace haptrial::protocols
