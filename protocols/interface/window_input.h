#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "core/device/device.h"

namespace haptrial::protocols {

/// Keys of the participant's window on their way from the screen's thread to the servo thread: the
/// functions that are held now, the characters that were typed, one a tick, and the pointer.
/// Neither side waits, allocates or throws.
class WindowInput {
 public:
  // Screen's thread.
  /// @param functions  DeviceReading::keys
  void hold(std::uint32_t functions) noexcept { held_.store(functions, std::memory_order_release); }
  /// Place and buttons may arrive a tick apart.
  void point(const device::WindowPointer& pointer) noexcept {
    pointer_x_.store(pointer.x, std::memory_order_relaxed);
    pointer_buttons_.store(pointer.buttons, std::memory_order_release);
  }
  /// A character is lost if the servo thread has not taken kRoom others, which no hand types.
  void type(char32_t character) noexcept {
    const std::size_t written = written_.load(std::memory_order_relaxed);
    if (written - taken_.load(std::memory_order_acquire) < kRoom) {
      typed_[written % kRoom] = character;
      written_.store(written + 1, std::memory_order_release);
    }
  }

  // Servo thread.
  /// Keys wait for the characters that were typed before them: Enter ends no answer that is not
  /// complete yet.
  std::uint32_t held() noexcept {
    const std::uint32_t now = held_.load(std::memory_order_acquire);
    const bool all_taken =
        taken_.load(std::memory_order_relaxed) == written_.load(std::memory_order_acquire);
    seen_ = all_taken ? now : seen_;
    return seen_;
  }
  device::WindowPointer pointer() const noexcept {
    const std::uint32_t buttons = pointer_buttons_.load(std::memory_order_acquire);
    return {pointer_x_.load(std::memory_order_relaxed), buttons};
  }
  /// The next character; 0: there is none.
  char32_t take_typed() noexcept {
    const std::size_t taken = taken_.load(std::memory_order_relaxed);
    if (taken == written_.load(std::memory_order_acquire)) {
      return 0;
    }
    const char32_t character = typed_[taken % kRoom];
    taken_.store(taken + 1, std::memory_order_release);
    return character;
  }

 private:
  static constexpr std::size_t kRoom = 64;

  std::atomic<std::uint32_t> held_{0};
  std::uint32_t seen_{0};  // held keys as the servo thread has them
  std::array<char32_t, kRoom> typed_{};
  std::atomic<std::size_t> written_{0}, taken_{0};
  std::atomic<double> pointer_x_{std::numeric_limits<double>::quiet_NaN()};
  std::atomic<std::uint32_t> pointer_buttons_{0};
};

}  // namespace haptrial::protocols
