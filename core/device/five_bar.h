#pragma once

#include <Eigen/Core>

namespace haptrial::device {

/// Lengths of a pantograph of five bars, in its own plane: motor 1 at (0, 0) and motor 2 at
/// (base, 0) each turn an arm, and two forearms join the ends A and B of the arms in the handle P,
/// to the left of the way from A to B.
struct FiveBar {
  double base{0.038};    // between the motors >= 0 [m]
  double arm{0.07};      // > 0 [m]
  double forearm{0.09};  // > 0 [m]
};

/// Handle of a pantograph at two angles of its motors.
struct FiveBarPose {
  /// Whether the angles belong to a handle whose force is defined: the forearms are at least 10°
  /// from one line. If not, the other members are zero.
  bool regular{false};
  Eigen::Vector2d handle{Eigen::Vector2d::Zero()};  // P [m]
  /// Derivative of P with respect to the angles, J [m/rad]. A force f on the handle takes the
  /// torques J^T f [N·m].
  Eigen::Matrix2d jacobian{Eigen::Matrix2d::Zero()};
};

/// Forward kinematics. With u = P - A and v = P - B the lengths of the forearms give
///
///     u·dP = u·dA,  v·dP = v·dB,
///
/// which define J unless u and v are parallel.
/// @param angles  of motor 1 and 2, from the line from motor 1 to motor 2, counterclockwise [rad]
FiveBarPose solve_five_bar(const FiveBar& bars, const Eigen::Vector2d& angles) noexcept;

}  // namespace haptrial::device
