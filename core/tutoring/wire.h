#pragma once

#include <cstdint>

#include "core/tutoring/simulated_channel.h"
#include "core/tutoring/tick_message.h"

namespace haptrial::tutoring {

/// A message and when it came, on this side's clock.
struct Arrived {
  TickMessage message;
  std::int64_t time_ns{0};
};

/// Counts of a network's effects, as one end saw them.
struct WireCounts {
  std::uint64_t sent{0};
  std::uint64_t accepted{0};
  std::uint64_t foreign{0};   // of another length or session
  std::uint64_t forged{0};    // not authentic, or without sense
  std::uint64_t repeated{0};  // or too old to tell
  std::uint64_t failed{0};    // that the system did not take
  std::uint64_t dropped{0};   // for want of room in a log

  bool operator==(const WireCounts&) const = default;
};

/// Receiver of messages that arrive. Servo thread.
class Listener {
 public:
  virtual ~Listener() = default;
  virtual void hear(const Arrived& arrived) noexcept = 0;
};

/// The way to the partner, as the loop of a session sees it: a real network or a simulated one.
/// Servo thread unless a function says otherwise; on a real clock nothing waits.
class Wire {
 public:
  virtual ~Wire() = default;

  /// Begins a tick; call once a tick, first of all. @returns the own clock [ns]
  virtual std::int64_t tick() noexcept = 0;
  /// Hands over the messages that have arrived since the last call, oldest first.
  virtual void receive(Listener& listener) noexcept = 0;
  virtual void send(const TickMessage& message) noexcept = 0;
  /// Whether the other end is known to be closed, so that nothing will come any more.
  virtual bool closed() const noexcept = 0;
  /// Sets the conditions of a simulated network from the next message of this side on; a real one
  /// is as it is.
  virtual void change(const ChannelConditions& conditions) noexcept {
    static_cast<void>(conditions);
  }
  /// Session's thread, when the loop has ended. @param last  said again until it will have come
  virtual void close(const TickMessage& last) noexcept = 0;
  virtual WireCounts counts() const noexcept = 0;  // any thread
};

}  // namespace haptrial::tutoring
