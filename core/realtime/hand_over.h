#pragma once

#include <atomic>
#include <cstdint>

#include "core/realtime/cache_line.h"

namespace haptrial::realtime {

/// Which of three slots is the writing thread's and which the reading thread's; the third is handed
/// over by an atomic exchange of its index. Neither side ever waits, and no slot is both sides'.
class HandOver {
 public:
  static constexpr std::uint8_t kSlots = 3;

  std::uint8_t writing() const noexcept { return writing_; }  // writer's to fill
  std::uint8_t reading() const noexcept { return reading_; }  // reader's to look at

  /// Publishes the slot that the writer filled as the newest; the writer gets another slot.
  void publish() noexcept {
    writing_ = handed_.exchange(writing_ | kNew, std::memory_order_acq_rel) & kIndex;
  }

  /// The reader gets the newest slot. @returns false if nothing was published since (or at all)
  bool take() noexcept {
    if ((handed_.load(std::memory_order_relaxed) & kNew) == 0) {
      return false;
    }
    reading_ = handed_.exchange(reading_, std::memory_order_acq_rel) & kIndex;
    return true;
  }

 private:
  static constexpr std::uint8_t kIndex = 3;
  static constexpr std::uint8_t kNew = 4;  // the slot was written after the last read

  alignas(kSeparation) std::atomic<std::uint8_t> handed_{1};
  alignas(kSeparation) std::uint8_t writing_{0};
  alignas(kSeparation) std::uint8_t reading_{2};
};

}  // namespace haptrial::realtime
