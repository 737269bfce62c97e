#include "core/base/camera.h"

namespace haptrial {

Eigen::Matrix3d Camera::axes() const noexcept {
  Eigen::Matrix3d axes;
  axes.col(2) = (eye - target).normalized();
  axes.col(0) = up.cross(axes.col(2)).normalized();
  axes.col(1) = axes.col(2).cross(axes.col(0));
  return axes;
}

Eigen::Isometry3d Camera::pose() const {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = axes();
  pose.translation() = eye;
  return pose;
}

}  // namespace haptrial
