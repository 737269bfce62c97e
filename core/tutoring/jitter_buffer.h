#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/tutoring/tick_message.h"

namespace haptrial::tutoring {

/// Gives messages out as evenly as they were sent, at the price of a delay that is chosen by what
/// was measured: the least delay under which at most `late` of the last kMeasured messages came too
/// late. Messages come in any order, each once (SequenceWindow). Servo thread.
class JitterBuffer {
 public:
  static constexpr std::size_t kMeasured = 1024;
  static constexpr std::size_t kMost = 1024;  // that wait; an older one gives way

  /// @param late   share of messages that may come too late, 0 to 1
  /// @param most   longest delay on top of the quickest message >= 0 [ns]
  JitterBuffer(double late, std::int64_t most) noexcept : late_(late), most_(most) {}

  /// @param now  own clock, when it came [ns]
  void put(const TickMessage& message, std::int64_t now) noexcept;
  /// The newest message whose turn has come; null before the first. @param now  own clock [ns]
  const TickMessage* take(std::int64_t now) noexcept;

  /// Delay on top of the quickest of the last messages [ns].
  std::int64_t delay() const noexcept { return delay_; }

 private:
  void measure(std::int64_t transit) noexcept;

  double late_;
  std::int64_t most_;
  std::array<std::int64_t, kMeasured> transits_{};  // own clock less the sender's, a ring
  std::array<std::int64_t, kMeasured> sorted_{};    // room for measure()
  std::uint64_t measured_{0};
  std::array<TickMessage, kMost> waiting_{};  // at sequence % kMost
  std::uint64_t highest_{0};                  // that waits or waited
  std::uint64_t out_{0};                      // that was given out last
  TickMessage given_;
  std::int64_t quickest_{0};  // transit
  std::int64_t delay_{0};
};

}  // namespace haptrial::tutoring
