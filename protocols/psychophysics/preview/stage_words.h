#pragma once

#include "protocols/psychophysics/definition/trials_definition.h"
#include "protocols/psychophysics/preview/previewed_trial.h"

namespace haptrial::protocols {

/// A stage with its conditions in words.
/// @param index  of the stage in its interval, from 0
PreviewedStage previewed_stage(const TrialsDefinition& definition, const Presented& presented,
                               std::size_t index);

}  // namespace haptrial::protocols
