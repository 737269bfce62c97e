#pragma once

#include <Eigen/Core>

#include "core/base/definition/schema.h"

namespace haptrial::protocols {

/// The screen on which trials are seen: a plane of W.
struct ScreenPlane {
  bool from_above{true};  // x to the right and z down; else x to the right and y up

  /// Direction of a way on the screen, counterclockwise from the right [rad].
  double angle_of(const Eigen::Vector3d& way) const noexcept;
  /// The way after a turn on the screen; its part across the screen is kept.
  Eigen::Vector3d turned(const Eigen::Vector3d& way, double angle) const noexcept;
  /// A way of this length on the screen, and of this part across it.
  Eigen::Vector3d along(double angle, double length, double across) const noexcept;
  double length_of(const Eigen::Vector3d& way) const noexcept;
  double across(const Eigen::Vector3d& way) const noexcept;
};

/// How the cursor moves with the tool of the first device ([cursor], numbers may be formulas):
///
///     cursor = about + gain · R(rotation) (tool - about) + noise,   as the tool was `delay` ago
///
/// A clamped cursor moves in one direction alone, by the length of gain · (tool - about).
struct CursorParameters {
  Eigen::Vector3d about{Eigen::Vector3d::Zero()};  // [m]
  double gain{1.0};
  double rotation{0.0};    // on the screen, counterclockwise [rad]
  double clamped{0.0};     // 1: it moves in `direction` alone
  double direction{0.0};   // on the screen, counterclockwise from the right [rad]
  double delay{0.0};       // [s]
  double noise{0.0};       // standard deviation in both directions of the screen [m]
  double noise_time{0.1};  // its correlation time [s]
};

const Schema<CursorParameters>& cursor_schema();

}  // namespace haptrial::protocols
