#pragma once

#include <algorithm>
#include <utility>

#include "core/contact/renderer.h"

namespace haptrial::contact {

/// The share of a surface's damper that acts at a depth [m]: all of it from 1 mm on, so that it
/// does not strike the hand where the contact begins. Any thread.
/// Source: Hunt and Crossley 1975, Journal of Applied Mechanics 42, 440.
inline double damper_share(double depth) noexcept {
  constexpr double kWhole = 1e-3;  // [m]
  return std::clamp(depth / kWhole, 0.0, 1.0);
}

/// Spring and damper along a surface's normal:
///
///     f = max(0, k depth + s b c(depth) u) n,  c = damper_share,  u = d depth / dt
///
/// s is the damping share, 1 unless the handle does not carry the damping.
/// It pushes and never pulls. u follows the readings with a time constant of 2 ms: the last step of
/// an encoder over a tick is mostly noise. It begins at 0, whatever the depth: a hand that is in
/// contact when the spring starts did not come from the surface in one tick.
class NormalSpring {
 public:
  explicit NormalSpring(const RendererOptions& options)
      : stiffness_(options.stiffness), damping_(options.damping), unit_(options.unit) {}

  void start() noexcept {
    rate_ = 0.0;
    begins_ = true;
  }
  void set_damping_share(double share) noexcept { share_ = share; }
  /// @param depth  0 when there is no contact [m]  @returns the size of the force [N]
  double force(double depth, double period) noexcept {
    if (std::exchange(begins_, false)) {
      before_ = depth;
    }
    if (period > 0.0) {
      constexpr double kFilter = 2e-3;  // [s]
      rate_ += period / (kFilter + period) * ((depth - before_) / period - rate_);
    }
    before_ = depth;
    const double damping = share_ * damping_ * damper_share(unit_ * depth);
    return depth > 0.0 ? std::max(0.0, stiffness_ * depth + damping * rate_) : 0.0;
  }
  double stiffness() const noexcept { return stiffness_; }

 private:
  double stiffness_, damping_, unit_;
  double share_{1.0};  // s
  double before_{0.0};
  double rate_{0.0};  // u [m/s]
  bool begins_{true};
};

}  // namespace haptrial::contact
