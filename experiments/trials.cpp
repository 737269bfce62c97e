#include "experiments/trials.h"

#include "experiments/bone_trials.h"
#include "experiments/force_trials.h"

namespace haptrial::experiments {

std::unique_ptr<Trials> make_trials(const SessionRequest& request, std::uint64_t session_seed) {
  if (request.bone != nullptr) {
    return std::make_unique<BoneTrials>(request, session_seed);
  }
  return std::make_unique<ForceTrials>(request, session_seed);
}

}  // namespace haptrial::experiments
