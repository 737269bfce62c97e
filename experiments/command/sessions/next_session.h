#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "analysis/statistics/design/sequential_looks.h"
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

/// How a study that may end early stands, by its finished sessions; nothing if its definition has
/// no [analysis.sequential], or nobody has finished a session.
/// @throws InputError for sessions that cannot be analysed
std::optional<analysis::SequentialResult> study_standing(const Experiment& experiment,
                                                         const std::filesystem::path& folder,
                                                         int threads);

bool has_ended(const std::optional<analysis::SequentialResult>& standing);

/// The sessions to run next: of a study that has ended, those that participants have left.
std::vector<RosterNext> next_sessions(const Roster& roster,
                                      const std::optional<analysis::SequentialResult>& standing);

/// A sentence for a study of which next_sessions() has none.
std::string words_without_next(const Roster& roster,
                               const std::optional<analysis::SequentialResult>& standing);

}  // namespace haptrial::experiments
