#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <type_traits>

#include "core/realtime/cache_line.h"

namespace haptrial::realtime {

/// Carries the newest value of something from one writing thread to one reading thread, whole: the
/// reader never sees half of one value and half of another, and neither side ever waits. Values
/// that nobody read in time are replaced; what must not be lost goes through a BlockLog.
///
/// Three slots: one is the writer's, one the reader's, and the third is handed over by an atomic
/// exchange of its index.
template <class T>
class LatestValue {
  // Not is_trivially_copyable: Eigen's fixed-size vectors are plain data with a written-out copy.
  static_assert(std::is_copy_assignable_v<T> && std::is_trivially_destructible_v<T>,
                "a value is plain data: it is copied without allocation");

 public:
  LatestValue() = default;
  LatestValue(const LatestValue&) = delete;
  LatestValue& operator=(const LatestValue&) = delete;

  /// Makes `value` the newest. Writer; wait-free.
  void write(const T& value) noexcept {
    slots_[writing_].value = value;
    writing_ = handed_.exchange(writing_ | kNew, std::memory_order_acq_rel) & kIndex;
  }

  /// Copies the newest value if it is newer than the one read last. Reader; wait-free.
  /// @returns false, leaving `value` alone, when nothing was written since (or at all).
  bool read(T& value) noexcept {
    if ((handed_.load(std::memory_order_relaxed) & kNew) == 0) {
      return false;
    }
    reading_ = handed_.exchange(reading_, std::memory_order_acq_rel) & kIndex;
    value = slots_[reading_].value;
    return true;
  }

 private:
  static constexpr std::uint8_t kIndex = 3;
  static constexpr std::uint8_t kNew = 4;  // the slot was written after the last read

  struct alignas(kSeparation) Slot {
    T value{};
  };
  std::array<Slot, 3> slots_{};
  alignas(kSeparation) std::atomic<std::uint8_t> handed_{1};
  alignas(kSeparation) std::uint8_t writing_{0};
  alignas(kSeparation) std::uint8_t reading_{2};
};

}  // namespace haptrial::realtime
