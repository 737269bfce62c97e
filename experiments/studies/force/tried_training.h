#pragma once

#include <memory>

#include "experiments/preview/tried_trial.h"
#include "protocols/force_training/force_definition.h"

namespace haptrial::experiments {

/// Training and test of a trial, by the passes of sessions; the test begins when the training is
/// over. @param definition  outlives the trial  @throws InputError for a trial beyond the session
std::shared_ptr<TriedTrial> tried_training(const protocols::ForceDefinition& definition,
                                           const PreviewRequest& request);

}  // namespace haptrial::experiments
