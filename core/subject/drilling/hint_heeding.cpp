#include "core/subject/drilling/hint_heeding.h"

#include <algorithm>

namespace haptrial::subject {
namespace {

constexpr double kLighter = 0.6, kLightest = 0.3;
constexpr double kSlower = 0.7, kSlowest = 0.4;
constexpr double kLooks = 15.0;    // after a hint about what is hidden [s]
constexpr double kForgets = 30.0;  // until 1/e of a change is left [s]

double worn_off(double value, double dt) noexcept {
  return value + std::min(1.0, dt / kForgets) * (1.0 - value);
}

}  // namespace

bool HintHeeding::notice(std::uint8_t hints, double dt) noexcept {
  lightness_ = worn_off(lightness_, dt);
  pace_ = worn_off(pace_, dt);
  looks_ = std::max(0.0, looks_ - dt);
  bool ends = false;
  for (const hint::HintKind kind : hint::kAllHintKinds) {
    Seen& seen = seen_[static_cast<std::size_t>(kind)];
    const bool on = (hints & hint::bit(kind)) != 0;
    if (on && !seen.on) {
      seen = {true, random_.uniform() < share_, 0.0};
    }
    seen.on = on;
    if (on && seen.heeded && (seen.since += dt) >= reaction_) {
      seen.heeded = false;
      ends = act(kind) || ends;
    }
  }
  return ends;
}

/// @returns whether what is being done has to end for it
bool HintHeeding::act(hint::HintKind kind) noexcept {
  switch (kind) {
    case hint::HintKind::kForce:
      lightness_ = std::max(kLightest, kLighter * lightness_);
      return false;
    case hint::HintKind::kSpeed:
      pace_ = std::max(kSlowest, kSlower * pace_);
      return true;
    default:
      looks_ = kLooks;
      return true;
  }
}

}  // namespace haptrial::subject
