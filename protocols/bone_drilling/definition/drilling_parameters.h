#pragma once

#include <Eigen/Core>
#include <optional>

#include "protocols/bone_drilling/definition/controls.h"
#include "protocols/bone_drilling/definition/second_hand.h"

namespace haptrial::protocols {

/// How a device becomes a tool on the bone.
struct DrillingParameters {
  Controls controls;
  /// Which way the handle runs, from the tip to the hand, in the frame of the device's orientation;
  /// in W where the device senses none. Any length but 0.
  Eigen::Vector3d handle{Eigen::Vector3d::UnitY()};
  /// The device's workspace is this many times as large as the scene's: motions are scaled down by
  /// it, forces are not. > 0
  double scale{1.0};
  double force_limit{10.0};                    // of what the device is asked for > 0 [N]
  double time_limit{900.0};                    // of a drilling > 0 [s]
  std::optional<SecondHandParameters> second;  // at a second device
};

}  // namespace haptrial::protocols
