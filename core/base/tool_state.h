#pragma once

#include <Eigen/Geometry>

#include "core/base/point_state.h"

namespace haptrial {

/// A tool in the world frame W: its tip, how that moves, and how the tool is turned.
struct ToolState {
  PointState tip;
  /// Rotation from the tool frame T to W. T's origin is the tip (the centre of a burr) and its z
  /// axis runs along the handle, from the tip to the hand.
  Eigen::Quaterniond orientation{Eigen::Quaterniond::Identity()};

  Eigen::Vector3d axis() const { return orientation * Eigen::Vector3d::UnitZ(); }
};

}  // namespace haptrial
