#include "protocols/force_training/visuohaptic_training.h"

namespace haptrial::protocols {

void VisuohapticTraining::present(stimulus::Presentation& presentation) const noexcept {
  presentation.instruction = stimulus::Instruction::kMatch;
  presentation.show_target_bar = true;
  presentation.show_applied_bar = true;
}

}  // namespace haptrial::protocols
