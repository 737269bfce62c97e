#pragma once

#include <optional>
#include <vector>

#include "analysis/psychophysics/data/trials_data.h"
#include "analysis/psychophysics/fit/reach_trials.h"
#include "analysis/psychophysics/fit/reaching_plan.h"

namespace haptrial::protocols {
struct TrialsDefinition;
}

namespace haptrial::experiments {

/// Reach of each trial according to the definition: its places, the field that is learnt, and the
/// other fields that act in the stage, read anew with the values that the session recorded. Nothing
/// for a trial that does not count.
/// @throws InputError when the recorded values do not fit the definition.
std::vector<std::optional<analysis::trials::ReachRoute>> reach_routes(
    const protocols::TrialsDefinition& definition, const analysis::trials::TrialsData& data,
    const analysis::trials::ReachingPlan& plan);

/// Names of the definition that [analysis] of kind "reaching" may use.
analysis::trials::ReachingNames reaching_names(const protocols::TrialsDefinition& definition);

}  // namespace haptrial::experiments
