#pragma once

#include <string>
#include <vector>

#include "core/realtime/servo_loop.h"
#include "experiments/loop_watch.h"
#include "experiments/session.h"
#include "experiments/session_desk.h"
#include "experiments/session_record.h"
#include "protocols/schedule.h"

namespace haptrial::experiments {

/// "3 of 72 trials planned, and 1 for practice". @param defined  trials of the definition
std::string planned_of(const std::vector<protocols::PlannedTrial>& plan, int defined);

/// What a session says of itself while it runs: in the terminal, on the console, in the file.
/// Session's thread.
class SessionNotices {
 public:
  /// All of them outlive the notices.
  struct Parts {
    const SessionRequest& request;
    const realtime::ServoLoop& loop;
    SessionRecord& record;
    SessionDesk& desk;
    SessionSummary& summary;
  };
  explicit SessionNotices(const Parts& parts) : p_(parts) {}

  /// A sentence that an experimenter has to know: once each, everywhere. Empty ones are none.
  void note(const std::string& notice);
  /// Whether the loop was refused real-time treatment, once it has begun.
  void note_real_time();
  /// The pass that has just ended. @param watch  of it
  void note_overruns(const LoopWatch& watch);

  /// What is recorded where, and how many trials.
  /// @param last  phase of a trial
  void say_plan(const std::vector<protocols::PlannedTrial>& plan, record::Phase last);
  /// @param how  "completed", "skipped", "aborted"
  void say_trial(const protocols::PlannedTrial& trial, const char* how) const;

 private:
  void tell(const std::string& line) const;

  Parts p_;
};

}  // namespace haptrial::experiments
