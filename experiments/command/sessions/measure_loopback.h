#pragma once

#include "experiments/command/sessions/device_bench.h"

namespace haptrial::experiments {

/// Prints how long after the pulse of each marker a sound or vibration left the card, by a
/// recording of both.
/// @returns the exit status: 1 if a pulse is not followed by the sound
/// @throws InputError for a definition without the sound, and a recording that shows no onset
int measure_loopback(const DeviceTestOptions& options);

}  // namespace haptrial::experiments
