#pragma once

#include <functional>
#include <string>
#include <vector>

#include "experiments/control/session_controller.h"
#include "experiments/runner/last_answer.h"
#include "experiments/runner/loop_pacing.h"
#include "experiments/runner/reported_mistakes.h"
#include "experiments/runner/session_notices.h"
#include "experiments/runner/session_record.h"
#include "experiments/runner/session_request.h"
#include "experiments/screen/screen.h"
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

/// Presents trials: shows each, runs its passes, keeps its answers. A trial is presented again when
/// the experimenter repeats it, when its answer is taken back, or when it was aborted while an
/// experimenter is there to see to the cause. Session's thread.
class TrialPresenter {
 public:
  /// All of them outlive it.
  struct Parts {
    const protocols::Definition& definition;
    protocols::Trials& trials;
    protocols::SessionTask& task;
    SessionRecord& record;
    SessionController& controller;
    LoopPacing& pacing;
    SessionNotices& notices;
    LastAnswer& last_answer;
    ReportedMistakes& mistakes;
    Screen* screen;  // null: none
    SessionSummary& summary;
    bool real{false};                // on a real clock
    std::function<void()> prepared;  // what took seconds is over
  };
  explicit TrialPresenter(const Parts& parts);

  /// One trial until it is done. @throws RunError as AbortedPass
  protocols::Outcome present(const protocols::PlannedTrial& trial);

 private:
  struct AttemptResult {
    protocols::TrialEnd end{protocols::TrialEnd::kAborted};
    bool again{true};  // another attempt follows
  };
  AttemptResult present_once(const protocols::PlannedTrial& trial);
  bool answer_stands(bool presented);
  bool run_passes(const protocols::PlannedTrial& trial, int attempt);
  bool run_pass(const protocols::PlannedTrial& trial, const record::Phase& phase, int attempt);
  void show();
  void keep_responses();
  void note_time_left(double trial_seconds);

  Parts p_;
  AbortedPass aborted_;
  std::vector<record::ResponseRow> responses_;  // of the present attempt
  double seconds_{0.0};                         // of the trials of this run
  int timed_{0};                                // trials whose time that is
};

}  // namespace haptrial::experiments
