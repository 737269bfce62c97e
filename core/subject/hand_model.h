#pragma once

#include <Eigen/Core>

#include "core/device/handle_physics.h"

namespace haptrial::subject {

/// Command of the nervous system to the hand for the next step.
struct HandCommand {
  double press{0.0};                               // motor command, downward > 0 [N]
  bool holds_posture{false};                       // keep the height stiffly, or yield to the guide
  Eigen::Vector3d force{Eigen::Vector3d::Zero()};  // by the whole arm, tremor included, in W [N]
};

/// A hand on the handle of a virtual device. Servo thread.
class HandModel : public device::HandlePhysics {
 public:
  /// Holds until the next command.
  virtual void command(const HandCommand& command) noexcept = 0;
};

}  // namespace haptrial::subject
