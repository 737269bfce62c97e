#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/record/rows/session_types.h"
#include "experiments/control/live_status.h"
#include "experiments/control/session_control.h"

namespace haptrial::experiments {

/// Ticks per second over the last second. One thread.
class TickRate {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// How many ticks there have been so far. @param now  never earlier than before
  void add(Time now, std::uint64_t ticks);
  /// [Hz]; 0 until two moments at least half a second apart are known.
  double rate() const;

 private:
  struct Moment {
    Time time;
    std::uint64_t ticks;
  };
  std::deque<Moment> moments_;  // of the last second, and the one before them
};

/// Requests of the experimenter that are not carried out yet.
struct PendingRequests {
  bool start{false};  // go on before the time of a break has passed
  bool pause{false};
  bool repeat{false};                        // the present trial
  bool skip{false};                          // the present trial
  bool abort{false};                         // the session
  bool for_good{false};                      // with abort: nobody goes on with it
  bool back{false};                          // to the item of a page before the present one
  std::optional<RequestSource> take_back{};  // the last answer, and who asked
  bool stopped{false};                       // by a fault or an emergency stop, until it is cleared
};

/// The session's side of its control: turns messages into requests and events, and shows how the
/// session stands. Without a control it does nothing. Session's thread.
class SessionController {
 public:
  /// Immediate actions of a message on the session.
  struct Actions {
    std::function<void()> break_off;  // the present pass
    std::function<void()> clear_fault;
    std::function<void(const std::string& kind, const std::string& text)> event;
    std::function<void(bool take)> lead{};  // of a partner's hand; empty: nobody is linked
  };
  SessionController(SessionControl* control, Actions actions);

  bool attended() const { return control_ != nullptr; }
  void follow(std::span<const record::Sample> samples, double period_ns);

  void take_messages();
  /// Answers to pages that came and nobody has taken yet.
  std::vector<SessionControl::Message> take_answers();
  PendingRequests& requests() { return requests_; }

  /// Fields that the session fills itself.
  SessionStatus& status() { return status_; }
  /// About 20 times a second, and at once where the state changes.
  void publish(const std::string& state);

 private:
  std::string trial_of(const SessionControl::Message& message) const;
  void heed(Request request, RequestSource by);

  SessionControl* control_;
  Actions actions_;
  LiveStatus live_;
  TickRate rate_;
  PendingRequests requests_;
  bool stop_recorded_{false};  // a person's stop, since the last clear; a fault stops, too
  std::vector<SessionControl::Message> answers_;
  SessionStatus status_;
  std::chrono::steady_clock::time_point published_{};
};

}  // namespace haptrial::experiments
