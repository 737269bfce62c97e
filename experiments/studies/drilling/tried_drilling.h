#pragma once

#include <memory>

#include "experiments/preview/tried_trial.h"
#include "protocols/bone_drilling/definition/bone_definition.h"

namespace haptrial::experiments {

/// A procedure on its bone, by the pass of sessions, with each tool at rest and with power. There
/// is no sound, and no hints are given; forbidden regions are felt.
/// @param definition  with its bones; outlives the trial
/// @throws InputError for a procedure beyond the session
std::shared_ptr<TriedTrial> tried_drilling(const protocols::BoneDefinition& definition,
                                           const PreviewRequest& request);

}  // namespace haptrial::experiments
