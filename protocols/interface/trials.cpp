#include "protocols/interface/trials.h"

#include <set>
#include <utility>

namespace haptrial::protocols {

FixedPlan::FixedPlan(std::vector<PlannedTrial> plan) : plan_(std::move(plan)) {}

Extent FixedPlan::extent(int most) const {
  Extent extent;
  std::set<std::int32_t> blocks;
  for (const PlannedTrial& trial : plan_) {
    if (most > 0 && !trial.practice && trial.trial > most) {
      continue;
    }
    ++(trial.practice ? extent.practice : extent.trials);
    if (!trial.practice) {
      blocks.insert(trial.block);
    }
  }
  extent.blocks = static_cast<int>(blocks.size());
  return extent;
}

}  // namespace haptrial::protocols
