#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <string>

#include "core/realtime/servo_loop.h"
#include "experiments/control/session_controller.h"
#include "experiments/runner/servo_thread.h"
#include "experiments/runner/session_record.h"
#include "experiments/runner/session_request.h"
#include "protocols/interface/rig.h"
#include "protocols/interface/session_task.h"

namespace haptrial::experiments {

/// Whether the servo loop keeps its rate. Session's thread.
///
/// A pass with too many overruns is told (analysis/quality/timing.h says how many).
/// A loop that makes less than four fifths of its ticks over a second, more than a fifth of them
/// overruns, does not catch up: it is overloaded, as with a device whose library takes longer than
/// a period. One delay that is caught up with, and a suspension, are neither.
class LoopWatch {
 public:
  using Time = std::chrono::steady_clock::time_point;
  explicit LoopWatch(double rate_hz) : rate_hz_(rate_hz) {}

  void begin_pass(std::uint64_t ticks, std::uint64_t overruns);
  /// Takes the loop's counts so far. @param now  never earlier than before
  /// @returns a sentence when the last second of the pass was overloaded.
  std::optional<std::string> overloaded(Time now, std::uint64_t ticks, std::uint64_t overruns);
  /// @returns what record::too_many_overruns() says of the pass.
  std::optional<std::string> end_pass(std::uint64_t ticks, std::uint64_t overruns) const;

 private:
  struct Moment {
    Time time;
    std::uint64_t ticks;
    std::uint64_t overruns;
  };
  double rate_hz_;
  Moment begin_{};
  std::deque<Moment> moments_;  // of the last second, and the one before them
};

class Screen;

/// How a session passes its time: while a pass runs, in breaks, and while the experimenter is to
/// say something. Whatever it waits for, it empties the logs, hears messages and shows how things
/// stand. Session's thread.
class LoopPacing {
 public:
  /// All of them outlive the pacing. @param screen, live  null where there is none
  struct Parts {
    const SessionRequest& request;
    realtime::ServoLoop& loop;
    SessionRecord& record;
    SessionController& controller;
    protocols::SessionTask& task;
    bool felt{false};  // somebody feels what the device does
    Screen* screen{nullptr};
    std::atomic<bool>* begin_pressed{nullptr};  // Enter or space, in the participant's window
    const record::LiveFigures* live{nullptr};
    std::function<void()> hear{};    // what else may have happened, asked often
    protocols::Rig* rig{nullptr};    // attended to while a pass runs
    std::function<bool()> speaks{};  // whether a text is being spoken; empty: never
  };
  explicit LoopPacing(const Parts& parts);

  /// Keeps the session alive while something takes seconds on its thread. @throws RunError on an
  /// interrupt
  void meanwhile();
  /// Drives the loop until the pass that was started has ended. @throws RunError on an interrupt
  void drive_until_idle();
  /// Waits on the real clock, without force. @param until_asked  or until the experimenter starts
  /// or stops
  /// @returns whether all of the time has passed
  bool wait(double seconds, const char* state, bool until_asked = false);
  /// A text until the experimenter starts; without one, until a key in the participant's window.
  void wait_to_begin(const std::string& text);
  void pause_where_asked();
  /// Waits without force after an abort, for the hand to come back into the workspace; ticks are
  /// recorded all the same. On a simulated clock, which drives virtual hands only, a fault is
  /// cleared then: nobody can be hurt, and a dry run is to go on. On the real clock a person clears
  /// it.
  void recover();
  /// Stopped on the real clock, until the fault may be cleared.
  void recover_when(const std::function<bool()>& may);
  void take_break();

  /// Whether the loop kept its rate in the present pass, or the last one.
  const LoopWatch& watch() const { return watch_; }
  /// Why that pass was broken off, where the loop was overloaded; else empty.
  const std::string& overload() const { return overload_; }

  /// Shows a text on the participant's screen and the experimenter's.
  void show_text(const std::string& text, const std::string& hint, double countdown = 0.0);
  void show_page(render::TextPage page, const std::string& text);
  /// How far what is being prepared has come. @param share  from 0 to 1
  void show_progress(double share);
  /// Waits until the participant has seen the first picture of what Screen::show() was given.
  /// @throws RunError on an interrupt
  void wait_for_picture(std::uint64_t number);
  /// Waits between two looks at a page's answer. @throws RunError on an interrupt
  void wait_a_little(const char* state);
  void publish(const char* state);
  /// A last page, for as long as it takes to read where there is a screen.
  void let_read(const std::string& text, const char* state);
  bool text_shown() const { return text_shown_; }
  void clear_text();  // what shows instead is not the pacing's

  /// @throws RunError that says where what was recorded is
  [[noreturn]] void end_early(const std::string& why) const;

 private:
  void collect();
  void wait_for_experimenter(const char* state, const std::string& text, const std::string& hint);
  void wait_for_participant();
  void wait_until_ready();
  void rest(bool until_asked);
  bool asked_to_stop() const;
  void watch_loop();

  Parts p_;
  const protocols::Definition& d_;
  const bool real_;
  StallWatch stall_;
  bool text_shown_{false};
  LoopWatch watch_;
  std::string overload_;
};

}  // namespace haptrial::experiments
