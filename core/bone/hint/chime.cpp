#include "core/bone/hint/chime.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace haptrial::hint {
namespace {

constexpr double kAttack = 0.005;  // [s]
constexpr double kDecay = 0.05;    // to 1/e [s]

}  // namespace

void Chime::mix(std::span<float> part) noexcept {
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
    const double pitch = second ? notes_.second : notes_.first;
    sample += static_cast<float>(notes_.loudness * shape *
                                 std::sin(2.0 * std::numbers::pi * pitch * time));
    at_ += 1.0 / card_;
  }
}

}  // namespace haptrial::hint
