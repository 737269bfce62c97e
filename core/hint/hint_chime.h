#pragma once

#include <atomic>
#include <cstdint>
#include <span>

namespace haptrial::hint {

/// The sound of a hint that begins: two falling notes. Any thread rings, another, the sound card's,
/// mixes; neither waits.
class HintChime {
 public:
  /// @param card  samples of the sound a second [Hz]
  explicit HintChime(double card = 48'000.0) noexcept : card_(card), at_(kNotes * kNote) {}

  void ring() noexcept { rung_.fetch_add(1, std::memory_order_relaxed); }
  /// Adds the next samples to what is there. No allocation.
  void mix(std::span<float> part) noexcept;

 private:
  static constexpr int kNotes = 2;
  static constexpr double kNote = 0.14;  // length of one [s]

  double card_;
  std::atomic<std::uint32_t> rung_{0};
  std::uint32_t heard_{0};
  double at_;  // since it was rung [s]
};

}  // namespace haptrial::hint
