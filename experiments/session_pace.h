#pragma once

#include <string>

#include "core/realtime/servo_loop.h"
#include "experiments/session.h"
#include "experiments/session_desk.h"
#include "experiments/session_record.h"
#include "protocols/session_task.h"

namespace haptrial::experiments {

class Screen;

/// How a session passes its time: while a pass runs, in breaks, and while the experimenter is to
/// say something. Whatever it waits for, it empties the logs, hears messages and shows how things
/// stand. Session's thread.
class SessionPace {
 public:
  /// All of them outlive the pace. @param screen, live  null where there is none
  struct Parts {
    const SessionRequest& request;
    realtime::ServoLoop& loop;
    SessionRecord& record;
    SessionDesk& desk;
    protocols::SessionTask& task;
    Screen* screen{nullptr};
    const LiveDrilling* live{nullptr};
  };
  explicit SessionPace(const Parts& parts);

  /// Until the pass that was started has ended. @throws RunError on an interrupt
  void drive_until_idle();
  /// On the real clock, without force. @param until_asked  or until the experimenter starts or
  /// stops
  void wait(double seconds, const char* state, bool until_asked = false);
  void wait_for_experimenter(const char* state);
  void pause_where_asked();
  /// Without force after an abort, for the hand to come back into the workspace; ticks are recorded
  /// all the same.
  void recover();
  void take_break();

  /// On the participant's screen and the experimenter's.
  void show_text(const std::string& text, const std::string& hint, double countdown = 0.0);
  void publish(const char* state);

  /// @throws RunError that says where what was recorded is
  [[noreturn]] void end_early(const std::string& why) const;

 private:
  void collect();
  bool asked_to_stop() const;

  Parts p_;
  const Setup& d_;
  const bool real_;
};

}  // namespace haptrial::experiments
