#pragma once

#include <Eigen/Geometry>
#include <span>
#include <vector>

namespace haptrial::evaluation {

/// Free where normal · p >= offset.
struct HalfSpace {
  Eigen::Vector3d normal;  // unit length
  double offset{0.0};      // [m]
};

/// The springs by which a hand leads a rigid tool: of its place and of its turn.
struct HandSprings {
  double stiffness{500.0};        // k_h > 0 [N/m]
  double turning_stiffness{0.3};  // k_t > 0 [N·m/rad]
};

/// Where a rigid tool rests, and what the hand feels.
struct TrueRest {
  Eigen::Isometry3d tool{Eigen::Isometry3d::Identity()};
  Eigen::Vector3d force{Eigen::Vector3d::Zero()};   // on the hand [N]
  Eigen::Vector3d torque{Eigen::Vector3d::Zero()};  // on it, about the tool's origin [N·m]
};

/// The rest of a hard convex tool in a hard body that leaves a convex space free: the least of
///
///     1/2 k_h |x - x_h|² + 1/2 k_t |θ|²
///
/// where every corner of the tool is in every half-space, by augmented Lagrangians to a nanometre.
/// There is no friction. Where there are several places of least energy it is the one that the tool
/// comes to from the tick before.
/// @param corners  of the tool, in T [m]  @param free  the half-spaces
/// @param hand  X_WT on each tick, the first one free
std::vector<TrueRest> true_rests(const std::vector<Eigen::Vector3d>& corners,
                                 std::span<const HalfSpace> free,
                                 std::span<const Eigen::Isometry3d> hand,
                                 const HandSprings& springs);

}  // namespace haptrial::evaluation
