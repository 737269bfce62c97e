#pragma once

#include <string>

#include "experiments/control/session_controller.h"
#include "experiments/runner/loop_pacing.h"
#include "experiments/runner/session_notices.h"
#include "experiments/runner/session_record.h"
#include "protocols/interface/session_task.h"
#include "protocols/interface/trials.h"

namespace haptrial::experiments {

/// Handling of a pass that was aborted: the reason is recorded and said; then somebody sees to the
/// cause, or the session ends, or the device recovers. After three in a row that nobody asked for
/// the session pauses, since the fourth would go the same way. Session's thread.
class AbortedPass {
 public:
  /// All of them outlive it.
  struct Parts {
    const protocols::Definition& definition;
    protocols::Trials& trials;
    SessionRecord& record;
    SessionController& controller;
    LoopPacing& pacing;
    SessionNotices& notices;
    bool real{false};  // on a real clock
  };
  explicit AbortedPass(const Parts& parts) : p_(parts) {}

  /// @throws RunError where nobody is there to see to a fault
  void see_to(const protocols::PassResult& result);
  void note_completed() { in_row_ = 0; }

 private:
  void pause_after_several(const std::string& why, bool asked);
  bool asked_for() const;
  std::string cause(const protocols::PassResult& result) const;
  std::string why_broken_off() const;
  void note_abort(const std::string& why);
  bool partner_stops() const;

  Parts p_;
  int in_row_{0};  // aborted passes that nobody asked for
};

}  // namespace haptrial::experiments
