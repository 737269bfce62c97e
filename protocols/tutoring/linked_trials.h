#pragma once

#include <memory>
#include <string>

#include "core/tutoring/wire.h"
#include "protocols/definition/tutoring_options.h"
#include "protocols/interface/trials.h"
#include "protocols/tutoring/linked_hand.h"

namespace haptrial::protocols {

/// Which side of a pair of sessions this one is, and how it reaches the other.
struct LinkChoice {
  LinkRole role{LinkRole::kLearns};
  std::shared_ptr<tutoring::Wire> wire;
  std::string session;  // of the link, the same on both sides; never the secret
};

/// "teaches" or "learns": for the session's event "tutor".
const char* name_of(LinkRole role) noexcept;

/// Trials of any protocol in step with those of another session, pass by pass, the first device's
/// hands coupled by the law of tutoring (source: Morris 2006, §3.4.1). What the link does is
/// recorded in /link, tick by tick. The session ends, to be resumed, where the other one does or is
/// not heard any more.
/// @param place  of the session; outlives the trials
std::unique_ptr<Trials> linked(std::unique_ptr<Trials> trials, const TutoringOptions& options,
                               const LinkChoice& link, const SessionPlace& place);

}  // namespace haptrial::protocols
