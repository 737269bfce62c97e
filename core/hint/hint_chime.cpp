#include "core/hint/hint_chime.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace haptrial::hint {
namespace {

constexpr double kHigh = 880.0;    // [Hz]
constexpr double kLow = 659.26;    // a fourth below [Hz]
constexpr double kLoudness = 0.2;  // of full scale
constexpr double kAttack = 0.005;  // [s]
constexpr double kDecay = 0.05;    // to 1/e [s]

}  // namespace

void HintChime::mix(std::span<float> part) noexcept {
  if (const std::uint32_t rung = rung_.load(std::memory_order_relaxed); rung != heard_) {
    heard_ = rung;
    at_ = 0.0;
  }
  for (float& sample : part) {
    if (at_ >= kNotes * kNote) {
      return;
    }
    const bool second = at_ >= kNote;
    const double time = second ? at_ - kNote : at_;
    const double shape = std::min(1.0, time / kAttack) * std::exp(-time / kDecay);
    sample += static_cast<float>(kLoudness * shape *
                                 std::sin(2.0 * std::numbers::pi * (second ? kLow : kHigh) * time));
    at_ += 1.0 / card_;
  }
}

}  // namespace haptrial::hint
