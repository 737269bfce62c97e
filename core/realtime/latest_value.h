#pragma once

#include <array>
#include <type_traits>

#include "core/realtime/cache_line.h"
#include "core/realtime/hand_over.h"

namespace haptrial::realtime {

/// Carries the newest value of something from one writing thread to one reading thread, whole: the
/// reader never sees half of one value and half of another, and neither side ever waits. Values
/// that nobody read in time are replaced; what must not be lost goes through a BlockLog.
template <class T>
class LatestValue {
  // The test is not is_trivially_copyable: Eigen's fixed-size vectors are plain data with a
  // written-out copy.
  static_assert(std::is_copy_assignable_v<T> && std::is_trivially_destructible_v<T>,
                "a value is plain data: it is copied without allocation");

 public:
  LatestValue() = default;
  LatestValue(const LatestValue&) = delete;
  LatestValue& operator=(const LatestValue&) = delete;

  /// Makes `value` the newest. Writer; wait-free.
  void write(const T& value) noexcept {
    slots_[turn_.writing()].value = value;
    turn_.publish();
  }

  /// Copies the newest value if it is newer than the one read last. Reader; wait-free.
  /// @returns false, leaving `value` alone, when nothing was written since (or at all).
  bool read(T& value) noexcept {
    if (!turn_.take()) {
      return false;
    }
    value = slots_[turn_.reading()].value;
    return true;
  }

 private:
  struct alignas(kSeparation) Slot {
    T value{};
  };
  std::array<Slot, HandOver::kSlots> slots_{};
  HandOver turn_;
};

}  // namespace haptrial::realtime
