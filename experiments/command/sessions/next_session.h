#pragma once

#include <optional>
#include <string>

#include "experiments/command/sessions/run_options.h"
#include "experiments/studies/experiment.h"
#include "experiments/study/roster.h"

namespace haptrial::experiments {

/// Minutes between two sessions, as --setup gives them. @throws InputError beyond 0 to 600
std::optional<double> checked_setup(std::optional<double> minutes);

/// `session` if the definition has it. @throws InputError naming the option
int checked_session(int session, const protocols::Definition& setup);

/// Fills in who is next in which session where the command line does not say it.
/// @returns a sentence that says who was chosen, and what comes; empty where nothing was left open
/// @throws InputError where nobody is next, or for a session that the definition does not have
std::string choose_session(RunOptions& options, const Experiment& experiment);

/// "P04 (group clockwise), session 2 of 4: visual, haptic"
std::string words_of(const RosterNext& next, int sessions);

}  // namespace haptrial::experiments
