#include "core/render/bone/bone_camera.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace haptrial::render {
namespace {

Eigen::Matrix4d projection_of(double near, double far, double height, double aspect, double shift) {
  // The frustum's sides at the near plane; off-axis by `shift`.
  const double top = 0.5 * height;
  const double right = top * aspect;
  Eigen::Matrix4d p = Eigen::Matrix4d::Zero();
  p(0, 0) = near / right;
  p(0, 2) = shift / right;
  p(1, 1) = near / top;
  p(2, 2) = -(far + near) / (far - near);
  p(2, 3) = -2.0 * far * near / (far - near);
  p(3, 2) = -1.0;
  return p;
}

/// @param aside  of the eye from the camera's, along x [m]
/// @param convergence  distance at which what lies there does not move [m]
EyeView view_from(const Camera& camera, double aside, double convergence, double aspect) {
  constexpr double kNear = 0.05;  // shares of the distance to the target
  constexpr double kFar = 20.0;
  const double near = kNear * camera.distance();
  const double height = 2.0 * near * std::tan(0.5 * camera.field_of_view);
  Eigen::Isometry3d pose = camera.pose();
  pose.translation() += aside * pose.linear().col(0);
  return {
      pose.inverse().matrix(),
      projection_of(near, kFar * camera.distance(), height, aspect, -aside * near / convergence),
      pose.translation()};
}

}  // namespace

Camera looking_at(const Eigen::AlignedBox3d& box, const Eigen::Vector3d& from,
                  const Eigen::Vector3d& up, double aspect, double field_of_view) {
  if (box.isEmpty() || !box.sizes().allFinite()) {
    throw std::invalid_argument("looking_at: a box of finite size is needed");
  }
  constexpr double kRoom = 1.05;
  Camera camera{box.center() + from.normalized(), box.center(), up, field_of_view};
  const Eigen::Matrix3d axes = camera.pose().linear();
  const double above = std::tan(0.5 * field_of_view) / kRoom;
  double distance = 1e-6;
  for (int c = 0; c < 8; ++c) {  // as far away as the corner that needs the most
    const Eigen::Vector3d corner = box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(c));
    const Eigen::Vector3d p = axes.transpose() * (corner - box.center());
    distance = std::max(
        {distance, p.z() + std::abs(p.y()) / above, p.z() + std::abs(p.x()) / (above * aspect)});
  }
  camera.eye = box.center() + distance * from.normalized();
  return camera;
}

Camera zoomed(const Camera& camera, double factor) {
  constexpr double kWidest = 2.8;  // [rad]
  Camera changed = camera;
  changed.field_of_view =
      std::min(2.0 * std::atan(std::tan(0.5 * camera.field_of_view) / factor), kWidest);
  return changed;
}

EyeView view_of(const Camera& camera, double aspect) {
  return view_from(camera, 0.0, camera.distance(), aspect);
}

EyeView stereo_view_of(const Camera& camera, const StereoPair& pair, int side, double aspect) {
  return view_from(camera, 0.5 * side * pair.eye_distance,
                   pair.convergence.value_or(camera.distance()), aspect);
}

}  // namespace haptrial::render
