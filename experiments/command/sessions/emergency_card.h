#pragma once

#include <filesystem>

#include "experiments/command/sessions/run_options.h"
#include "experiments/studies/experiment.h"

namespace haptrial::experiments {

/// Writes a page to be printed and laid beside the device: how to stop it, what to do if somebody
/// is hurt or the program hangs, whom to call, where the files lie and how to go on. It needs
/// nothing but the definition, the lab file and the options of the session.
/// @param terminal  sessions have one whose keys they read; those that the studio starts have none
/// @throws InputError if the file is there already; RunError if it cannot be written
void write_emergency_card(const RunOptions& options, const Experiment& experiment, bool terminal,
                          const std::filesystem::path& file);

}  // namespace haptrial::experiments
