#pragma once

#include <vector>

#include "experiments/command/start/machine_checks.h"
#include "experiments/studies/experiment.h"

namespace haptrial::experiments {

/// Opens the channels of a definition for a moment: whether each gives data, and its newest values.
/// A channel that a session needs is broken if it does not answer, any other is limited.
std::vector<MachineCheck> channel_checks(const Experiment& experiment);

}  // namespace haptrial::experiments
