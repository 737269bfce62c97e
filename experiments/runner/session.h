#pragma once

#include "experiments/runner/session_request.h"

namespace haptrial::experiments {

/// Runs the session and writes its file. A session that had ended but was killed before its file
/// was renamed is only renamed. An interrupt, or a failure of a simulated session, leaves nothing;
/// a session on the real clock keeps its records as FILE.partial.
/// @throws RunError, InputError
SessionSummary run_session(const SessionRequest& request);

}  // namespace haptrial::experiments
