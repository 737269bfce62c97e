#pragma once

#include <Eigen/Core>

#include "core/base/point_state.h"
#include "core/control/pd_controller.h"

namespace haptrial::scene {

/// The force of a spring and damper to a place that is searched for on every tick: the proxy on a
/// mesh, the nearest place of a curve. At an edge or a corner the place is found elsewhere from one
/// tick to the next. What the hand's way does not explain then comes by degrees, by at most 200
/// N/s:
///
///     |f - f before| <= k |way| + b (|v - v before| + |v| |way| / 1 mm) + 200 N/s T
///
/// so that the old force goes as a rest that only shrinks. Servo thread: no allocation, lock, I/O
/// or throw.
class FoundEnd {
 public:
  explicit FoundEnd(const control::PdGains& gains) noexcept : gains_(gains) {}

  /// Forgets the tick before: the next force comes as it is.
  void start() noexcept { follows_ = false; }
  /// @param force  as the place of this tick has it, without the share of stiffness [N]
  /// @param period  > 0 [s]  @returns the force to give
  Eigen::Vector3d bounded(const Eigen::Vector3d& force, const PointState& hand,
                          double period) noexcept;

 private:
  control::PdGains gains_;
  bool follows_{false};
  PointState hand_;                                 // a tick ago
  Eigen::Vector3d force_{Eigen::Vector3d::Zero()};  // likewise [N]
};

}  // namespace haptrial::scene
