#pragma once

#include "experiments/command/sessions/device_bench.h"

namespace haptrial::experiments {

/// Identifies what the device does, and writes its certificate into the folder of the options.
/// @returns the exit status
/// @throws InputError for options that are not allowed, RunError if the device fails meanwhile
int certify_device(const DeviceTestOptions& options, const DeviceSetup& setup);

}  // namespace haptrial::experiments
