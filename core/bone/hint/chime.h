#pragma once

#include <atomic>
#include <cstdint>
#include <span>

namespace haptrial::hint {

struct ChimeNotes {
  double first{880.0};    // [Hz]
  double second{659.26};  // a fourth below [Hz]
  double loudness{0.2};   // of full scale
};
/// The notes of an injury: louder and lower than those of a hint.
inline constexpr ChimeNotes kInjuryNotes{440.0, 220.0, 0.5};

/// Two falling notes when a hint begins or a vital structure is opened. Any thread rings, another,
/// the sound card's, mixes; neither waits.
class Chime {
 public:
  /// @param card  samples of the sound a second [Hz]
  explicit Chime(const ChimeNotes& notes = {}, double card = 48'000.0) noexcept
      : notes_(notes), card_(card), at_(kNotes * kNote) {}

  void ring() noexcept { rung_.fetch_add(1, std::memory_order_relaxed); }
  /// Adds the next samples to what is there. No allocation.
  void mix(std::span<float> part) noexcept;

 private:
  static constexpr int kNotes = 2;
  static constexpr double kNote = 0.14;  // length of one [s]

  ChimeNotes notes_;
  double card_;
  std::atomic<std::uint32_t> rung_{0};
  std::uint32_t heard_{0};
  double at_;  // since it was rung [s]
};

}  // namespace haptrial::hint
