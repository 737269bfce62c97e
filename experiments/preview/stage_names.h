#pragma once

#include <string>
#include <vector>

#include "protocols/psychophysics/preview/previewed_trial.h"

namespace haptrial::experiments {

/// "1 comparison: press"; without the interval in a trial of one.
std::string stage_name(const protocols::PreviewedTrial& trial, const protocols::StagePlace& place);

/// The names of stages, one after the other.
std::string stage_names(const protocols::PreviewedTrial& trial,
                        const std::vector<protocols::StagePlace>& places);

}  // namespace haptrial::experiments
