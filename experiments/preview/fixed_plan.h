#pragma once

#include <functional>
#include <vector>

#include "analysis/document/document.h"
#include "protocols/definition/definition.h"

namespace haptrial::experiments {

/// Trials by condition over the participants of a study whose order of trials is known from the
/// beginning: a heading and a table.
/// @param trials_of  the trials of the first session of a participant, from 0
void add_fixed_plan(const protocols::Definition& definition,
                    const std::function<std::vector<protocols::PlannedTrial>(int)>& trials_of,
                    analysis::Document& document);

}  // namespace haptrial::experiments
