#pragma once

#include <filesystem>
#include <vector>

#include "experiments/command/start/machine_checks.h"

namespace haptrial::protocols {
struct Definition;
}

namespace haptrial::experiments {

/// The checks of `doctor`, in a fixed order: clock, real time, pictures, window, sound, video,
/// stream, disk, every device, a Touch, the definition's pedal. They take some seconds.
/// @param definition  whose sessions are to run here; null: any. Checks of what its sessions do
///                    without are kUnused
/// @param folder      for session files; is there
std::vector<MachineCheck> doctor_checks(const protocols::Definition* definition,
                                        const std::filesystem::path& folder);

}  // namespace haptrial::experiments
