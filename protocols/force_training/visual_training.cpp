#include "protocols/force_training/visual_training.h"

namespace haptrial::protocols {

void VisualTraining::present(stimulus::Presentation& presentation) const noexcept {
  presentation.instruction = stimulus::Instruction::kWatch;
  presentation.show_target_bar = true;
}

}  // namespace haptrial::protocols
