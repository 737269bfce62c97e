#pragma once

#include "experiments/runner/session_request.h"

namespace haptrial::experiments {

/// Runs the session and writes its file. One that had ended and was killed before its file had its
/// name is only closed. On an interrupt or a failure of a simulated session
/// nothing is left; a session on the real clock keeps what it recorded as FILE.partial.
/// @throws RunError, InputError
SessionSummary run_session(const SessionRequest& request);

}  // namespace haptrial::experiments
