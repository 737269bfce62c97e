#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "analysis/statistics/design/sequential_looks.h"
#include "experiments/studies/experiment.h"
#include "experiments/study/roster.h"

namespace haptrial::experiments {

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

}  // namespace haptrial::experiments
