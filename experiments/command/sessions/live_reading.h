#pragma once

#include "experiments/command/sessions/device_bench.h"
#include "protocols/definition/definition.h"

namespace haptrial::experiments {

/// Prints where the handle of a device is, five times a second, without any force. A device that no
/// person moves is moved along its axes. Ends after the options' seconds or at an interrupt.
/// @returns 0 if the device answered every time, else 1
int print_live_device(const DeviceTestOptions& options, const DeviceSetup& setup);

/// Prints the newest values of the definition's channels, likewise, and records nothing.
/// @returns 0 if every channel answered at the end, else 1
int print_live_channels(const protocols::Definition& definition, double seconds);

}  // namespace haptrial::experiments
