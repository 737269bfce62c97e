#pragma once

#include <filesystem>
#include <optional>

#include "analysis/statistics/design/sequential_looks.h"
#include "experiments/studies/experiment.h"

namespace haptrial::experiments {

/// How a study that may end early stands, by its finished sessions; nothing if its definition has
/// no [analysis.sequential], or nobody has finished a session.
/// @throws InputError for sessions that cannot be analysed
std::optional<analysis::SequentialResult> study_standing(const Experiment& experiment,
                                                         const std::filesystem::path& folder,
                                                         int threads);

bool has_ended(const std::optional<analysis::SequentialResult>& standing);

}  // namespace haptrial::experiments
