#pragma once

#include <optional>

#include "experiments/command/sessions/run_options.h"
#include "experiments/runner/session_request.h"

namespace haptrial::experiments {

/// Waits for the other side of a link, or goes to it; nothing without --teach and --learn-from.
/// @param request  all that says what is presented
/// @throws InputError, RunError as tutoring::meet() does
std::optional<protocols::LinkChoice> meet_partner(const RunOptions& options,
                                                  const SessionRequest& request,
                                                  const protocols::Definition& definition);

}  // namespace haptrial::experiments
