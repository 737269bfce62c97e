#pragma once

#include <filesystem>

#include "experiments/runner/session.h"

namespace haptrial::experiments {

/// Name of the folder, below that of the sessions, for the records of the side that teaches.
inline constexpr const char* kTeaching = "teaching";

/// A dry session, and a second one in the same process whose virtual participant leads it over the
/// network of [tutoring.channel]. Both files are functions of definition, subject and seed.
/// @param request  of the side that learns, on the simulated clock
/// @param folder   beside its file, for that of the side that teaches
/// @returns the summary of the side that learns
SessionSummary run_taught_session(const SessionRequest& request,
                                  const std::filesystem::path& folder);

}  // namespace haptrial::experiments
