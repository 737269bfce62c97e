#pragma once

#include <algorithm>

#include "core/contact/renderer/renderer.h"

namespace haptrial::contact {

/// Spring and damper along a surface's normal:
///
///     f = max(0, k depth + b (d depth / dt)) n
///
/// It pushes and never pulls.
class NormalSpring {
 public:
  explicit NormalSpring(const RendererOptions& options)
      : stiffness_(options.stiffness), damping_(options.damping) {}

  void start() noexcept { before_ = 0.0; }
  /// @param depth  0 when there is no contact [m]  @returns the size of the force [N]
  double force(double depth, double period) noexcept {
    const double rate = period > 0.0 ? (depth - before_) / period : 0.0;
    before_ = depth;
    return depth > 0.0 ? std::max(0.0, stiffness_ * depth + damping_ * rate) : 0.0;
  }
  double stiffness() const noexcept { return stiffness_; }

 private:
  double stiffness_, damping_;
  double before_{0.0};
};

}  // namespace haptrial::contact
