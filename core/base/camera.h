#pragma once

#include <Eigen/Geometry>

namespace haptrial {

/// An eye that looks at a point, zoomed by its field of view. In W.
struct Camera {
  Eigen::Vector3d eye{0.0, 0.0, 0.25};              // [m]
  Eigen::Vector3d target{Eigen::Vector3d::Zero()};  // [m]
  Eigen::Vector3d up{Eigen::Vector3d::UnitY()};     // any length but 0, not along the view
  double field_of_view{0.35};                       // from bottom to top, 0 to pi [rad]

  bool operator==(const Camera&) const = default;
  double distance() const { return (target - eye).norm(); }  // [m]
  /// Right, up and towards the eye in the picture, as columns; orthonormal.
  Eigen::Matrix3d axes() const noexcept;
  /// Transform from the camera's axes, with their origin at the eye, to W.
  Eigen::Isometry3d pose() const;
};

}  // namespace haptrial
