#include "experiments/drilling_rig.h"

#include "core/base/random.h"

namespace haptrial::experiments {

DrillingRig::DrillingRig(const BoneDefinition& d, std::uint64_t session_seed)
    : hand_(d.hand, 1.0 / d.rate, d.hand_plan.start - 2.0 * d.hand_plan.hover * d.hand_plan.inward),
      device_(d.device, hand_, d.rate),
      subject_(d.hand_plan, hand_, device_, d.drilling.scale, derived_seed(session_seed, "subject"),
               1.0 / d.rate) {}

}  // namespace haptrial::experiments
