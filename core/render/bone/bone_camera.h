#pragma once

#include <Eigen/Geometry>
#include <optional>

#include "core/base/camera.h"

namespace haptrial::render {

/// A camera that shows the whole of a box, with a little room around.
/// @param from   from the box's middle to the eye, any length but 0
/// @param aspect width through height of the picture
/// @throws std::invalid_argument where the box is empty or not finite.
Camera looking_at(const Eigen::AlignedBox3d& box, const Eigen::Vector3d& from,
                  const Eigen::Vector3d& up, double aspect, double field_of_view = 0.35);

/// Things become `factor` > 0 times as large in the picture, by a narrower field of view.
Camera zoomed(const Camera& camera, double factor);

/// A stereo pair, side by side: left eye left.
struct StereoPair {
  double eye_distance{0.02};          // >= 0 [m]
  std::optional<double> convergence;  // distance without disparity > 0 [m]; else the target's
};

/// Transforms for the vertex shader: from W to the eye, and from there to the clip space of OpenGL.
struct EyeView {
  Eigen::Matrix4d view;
  Eigen::Matrix4d projection;
  Eigen::Vector3d eye;  // in W [m]
};

/// @param aspect  width through height of the picture
EyeView view_of(const Camera& camera, double aspect);
/// An eye beside the camera's with an off-axis frustum, so that what lies at the distance of
/// convergence is at the same place in both pictures.
/// @param side  -1 left eye, +1 right eye
EyeView stereo_view_of(const Camera& camera, const StereoPair& pair, int side, double aspect);

}  // namespace haptrial::render
