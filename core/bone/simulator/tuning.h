#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "core/bone/drill/feel.h"

namespace haptrial::bone {

inline constexpr std::size_t kMostTools = 32;  // that a participant can take in hand

/// Constants of a burr that may change while it works. Plain data.
struct BurrTuning {
  FeelParameters feel{};
  double removal_rate{0.0};     // as BurrParameters has it [1/(N·s)]
  double falloff{0.0};          // likewise [1/(N·s·rad)]
  double tangential_gain{0.0};  // likewise [N/m^4]
};

/// Constants of a simulator that may change while it ticks. Plain data of fixed size, which goes
/// through a latest-value channel.
struct Tuning {
  std::array<BurrTuning, kMostTools> burrs{};  // by tool; unused where it is no burr
  FeelParameters tube{};                       // of the other hand's
};

/// Transition from one law of force to another while a hand may press: the force is
///
///     f = (1 - w) f_before + w f_now,   w growing from 0 to 1 over kTime
///
/// so that no change of constants steps it: with both forces at most F it moves by at most
/// 2 F dt / kTime a tick beyond its own motion. Servo thread.
class ForceTransition {
 public:
  static constexpr double kTime = 0.25;  // [s]

  void begin() noexcept { left_ = kTime; }
  void end() noexcept { left_ = 0.0; }
  void step(double dt) noexcept { left_ = std::max(0.0, left_ - dt); }
  bool is_on() const noexcept { return left_ > 0.0; }
  double weight() const noexcept { return 1.0 - left_ / kTime; }

 private:
  double left_{0.0};  // [s]
};

}  // namespace haptrial::bone
