#pragma once

#include <Eigen/Core>

namespace haptrial::stimulus {

/// What the participant is to see at one instant. Written whole by the servo thread each tick; read
/// by the renderer and by a virtual subject, so both see the same thing.
/// Source: Morris 2006, §4.2.4, Figure 24.
struct Presentation {
  Eigen::Vector3d tool{Eigen::Vector3d::Zero()};  // device position in W [m]
  bool show_trajectory{false};   // the spatial trajectory of the block and the tool on it
  bool show_target_bar{false};   // blue bar: target normal force
  bool show_applied_bar{false};  // green bar: normal force that the participant applies
  bool show_saturation{false};   // small square: the device is at its force limit
  double target_force{0.0};      // [N]
  double applied_force{0.0};     // [N]
  double progress{0.0};          // arc position along the trajectory, 0 to 1
};

}  // namespace haptrial::stimulus
