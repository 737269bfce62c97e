#pragma once

#include <string>
#include <vector>

#include "core/realtime/servo_loop.h"
#include "experiments/control/session_controller.h"
#include "experiments/runner/loop_pacing.h"
#include "experiments/runner/session_record.h"
#include "experiments/runner/session_request.h"
#include "experiments/screen/screen.h"
#include "protocols/interface/session_task.h"
#include "protocols/interface/trials.h"

namespace haptrial::experiments {

/// "3 of 72 trials planned, and 1 for practice". @param defined  trials of the definition
std::string planned_of(const protocols::Extent& extent, int defined);

/// Messages of a session while it runs: in the terminal, on the console, in the file. Session's
/// thread.
class SessionNotices {
 public:
  /// All of them outlive the notices.
  struct Parts {
    const SessionRequest& request;
    const realtime::ServoLoop& loop;
    SessionRecord& record;
    SessionController& controller;
    SessionSummary& summary;
  };
  explicit SessionNotices(const Parts& parts) : p_(parts) {}

  /// A sentence that an experimenter has to know: once each, everywhere. Empty ones are none.
  void note(const std::string& notice);
  void note(const std::vector<std::string>& notices);
  /// Whether the loop was refused real-time treatment, once it has begun.
  void note_real_time();
  /// The pass that has just ended. @param watch  of it
  void note_overruns(const LoopWatch& watch);

  /// Notes trouble of the pass that has just ended, if it did not end the pass.
  void note_pass(const protocols::PassResult& result);
  /// Notes troubles at the end of the session. @param live, screen  null where there is none
  void note_troubles(const record::LiveFigures* live, const Screen* screen);

  /// Says where the session is recorded, and how many trials it has.
  /// @param defined  trials of the whole session  @param over  of them, from earlier runs
  void say_plan(const protocols::Extent& extent, int defined, int over);
  /// Says in the terminal that a fault has stopped a trial, and how to go on; the console shows it
  /// by itself.
  void say_stopped(int trial, const std::string& why) const;
  /// @param how  "completed", "skipped", "aborted"
  void say_trial(const protocols::PlannedTrial& trial, const char* how) const;

 private:
  void tell(const std::string& line) const;

  Parts p_;
};

}  // namespace haptrial::experiments
