#pragma once

#include <cstdint>

#include "core/tutoring/sequence_window.h"
#include "core/tutoring/wire.h"

namespace haptrial::protocols {

/// How well messages come through. Servo thread.
class LinkQuality {
 public:
  void hear(const tutoring::Arrived& arrived) noexcept;
  /// Takes a tick's counts; call once a tick. @param window  of the messages
  void step(const tutoring::SequenceWindow& window, std::int64_t now_ns) noexcept;

  /// Mean change of the time under way from message to message (RFC 3550, 6.4.1) [s].
  double jitter() const noexcept { return jitter_; }
  double loss() const noexcept { return loss_; }  // share of the last second's messages

 private:
  std::int64_t transit_{0};  // of the message before, up to the clocks' offset [ns]
  bool begun_{false};
  double jitter_{0.0};
  std::int64_t second_ends_{0};
  std::uint64_t highest_{0};  // at the beginning of the second
  std::uint64_t accepted_{0};
  double loss_{0.0};
};

}  // namespace haptrial::protocols
