#pragma once

#include "protocols/interface/replay.h"

namespace haptrial::protocols {

class Protocol;

/// Draws one trial of a recorded session again as the participant saw it: what each stage showed,
/// the hands where they were, the questions until they were answered. The trials before it are led
/// through the definition with their recorded outcomes, so that procedures stand where they stood.
/// @param protocol  that of trials, which reads the definition
/// @throws InputError for what the file does not hold; RunError if this version of the program
/// would present other values than those that are recorded
void replay_trials(const Protocol& protocol, const ReplayRequest& request);

}  // namespace haptrial::protocols
