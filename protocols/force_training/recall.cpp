#include "protocols/force_training/recall.h"

namespace haptrial::protocols {

void RecallTest::present(stimulus::Presentation& presentation) const noexcept {
  presentation.instruction = stimulus::Instruction::kRecall;
}

}  // namespace haptrial::protocols
