#include "protocols/force_training/watching_training.h"

namespace haptrial::protocols {

void WatchingTraining::present(stimulus::Presentation& presentation) const noexcept {
  presentation.instruction = stimulus::Instruction::kWatch;
  presentation.show_target_bar = true;
  presentation.tool = expert_place(presentation.progress);
}

}  // namespace haptrial::protocols
