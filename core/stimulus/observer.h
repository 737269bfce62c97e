#pragma once

#include "core/stimulus/presentation.h"

namespace haptrial::stimulus {

/// Somebody to whom a pass is presented, tick by tick: a virtual subject, or the screen.
class Observer {
 public:
  virtual ~Observer() = default;
  /// @param presentation  what is to be seen at this tick
  /// @param device_force  what the device applies to the hand, in W [N]
  /// @param dt            since the previous tick [s]
  /// Servo thread: no allocation, lock, I/O or throw.
  virtual void observe(const Presentation& presentation, const Eigen::Vector3d& device_force,
                       double dt) noexcept = 0;
};

}  // namespace haptrial::stimulus
