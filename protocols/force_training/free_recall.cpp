#include "protocols/force_training/free_recall.h"

namespace haptrial::protocols {

void FreeRecall::present(stimulus::Presentation& presentation) const noexcept {
  presentation.instruction = stimulus::Instruction::kReproduce;
  presentation.show_trajectory = false;
}

}  // namespace haptrial::protocols
