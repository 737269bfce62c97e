#pragma once

#include <Eigen/Core>

#include "core/base/point_state.h"

namespace haptrial::device {

/// Load on a virtual device's handle: it moves the handle under the motors' force.
class HandlePhysics {
 public:
  virtual ~HandlePhysics() = default;
  /// Advances by `dt` [s] under `motor_force` [N] in W, held over the step.
  /// @returns the true handle state at the end. Servo thread.
  virtual PointState step(const Eigen::Vector3d& motor_force, double dt) noexcept = 0;
  virtual PointState state() const noexcept = 0;
};

}  // namespace haptrial::device
