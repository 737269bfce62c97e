#pragma once

#include <optional>

#include "experiments/runner/session_pages.h"
#include "experiments/runner/session_record.h"
#include "experiments/runner/session_request.h"
#include "protocols/interface/trials.h"

namespace haptrial::experiments {

/// Which trial a session is to present next: the procedure's, without those that an earlier run
/// recorded. Session's thread.
class NextTrial {
 public:
  /// All of them outlive it.
  struct Parts {
    const SessionRequest& request;
    protocols::Trials& trials;
    const SessionRecord& record;
    SessionPages& pages;
  };
  explicit NextTrial(const Parts& parts) : p_(parts) {}

  /// The next trial that is not recorded. The outcome of a recorded one goes into the same
  /// procedure, which leads to the same trials. Pages that the earlier run left unanswered are
  /// asked on the way.
  /// @param last  what came of the trial before; null at first
  /// @returns nothing at the end of the session, and where it was ended at a page
  std::optional<protocols::PlannedTrial> after(const protocols::Outcome* last);
  bool ended_at_page() const { return ended_at_page_; }

 private:
  Parts p_;
  bool ended_at_page_{false};
};

}  // namespace haptrial::experiments
