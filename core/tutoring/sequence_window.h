#pragma once

#include <bitset>
#include <cstdint>

namespace haptrial::tutoring {

/// Takes each sequence number once: a message that comes twice, or so late that nobody can tell
/// whether it did, is refused. As in RFC 4303, 3.4.3. Numbers begin with 1.
/// Servo thread.
class SequenceWindow {
 public:
  static constexpr std::uint64_t kSpan = 1024;  // messages that may overtake one

  /// @returns whether the number is new
  bool accept(std::uint64_t sequence) noexcept;
  /// The same without taking it: whether it is worth a look.
  bool would_accept(std::uint64_t sequence) const noexcept;

  std::uint64_t highest() const noexcept { return highest_; }
  std::uint64_t accepted() const noexcept { return accepted_; }
  /// Numbers up to the highest that never came.
  std::uint64_t missing() const noexcept { return highest_ - accepted_; }

 private:
  std::bitset<kSpan> seen_;  // at sequence % kSpan
  std::uint64_t highest_{0};
  std::uint64_t accepted_{0};
};

}  // namespace haptrial::tutoring
