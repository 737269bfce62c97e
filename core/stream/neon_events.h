#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "core/stream/onset_log.h"

namespace haptrial::markers {

/// An event that the phone took, or did not.
struct NeonEvent {
  TimedOnset onset;
  std::int64_t taken_ns{
      -1};  // when it had answered, on the session's clock; -1: it did not take it
};

/// Sends onsets to the phone of a Pupil Labs Neon as events of its recording, each with the time of
/// its tick, from a thread of its own: a phone takes milliseconds to answer, and may be away. The
/// destructor waits for the phone's answer to what was sent last; the rest is left.
class NeonEvents {
 public:
  /// @param address  of the phone: "HOST" or "HOST:PORT"
  /// @param now      the session's clock [ns], asked by the thread
  NeonEvents(const std::string& address, std::function<std::int64_t()> now);
  NeonEvents(const NeonEvents&) = delete;
  NeonEvents& operator=(const NeonEvents&) = delete;

  /// @param name  of the event, as the recording shows it. Any thread but the servo thread
  void send(const TimedOnset& onset, std::string name);
  /// Events that have been answered since the last call. Any one thread.
  std::vector<NeonEvent> take_sent();
  /// Whether all have been answered. Any thread.
  bool all_sent() const;
  /// Counts what has not been answered as not taken, and sends none of it. Any thread.
  void give_up();
  /// Why the phone did not take an event, in a sentence; empty while it took all. Any thread.
  std::string trouble() const;

 private:
  struct PendingEvent {
    TimedOnset onset;
    std::string name;
  };
  void run(const std::stop_token& stop);
  std::string post(const PendingEvent& asked) const;

  std::string host_;
  int port_;
  std::function<std::int64_t()> now_;
  mutable std::mutex mutex_;  // all that follow
  std::condition_variable_any changed_;
  std::deque<PendingEvent> asked_;  // the first is under way
  std::vector<NeonEvent> sent_;
  std::string trouble_;
  std::jthread thread_;  // last: it uses the others
};

}  // namespace haptrial::markers
