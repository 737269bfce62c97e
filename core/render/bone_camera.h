#pragma once

#include <Eigen/Geometry>
#include <optional>

namespace haptrial::render {

/// An operating microscope: an eye that looks at a point, zoomed by its field of view.
struct BoneCamera {
  Eigen::Vector3d eye{0.0, 0.0, 0.25};              // in W [m]
  Eigen::Vector3d target{Eigen::Vector3d::Zero()};  // in W [m]
  Eigen::Vector3d up{Eigen::Vector3d::UnitY()};     // any length, not along the view
  double field_of_view{0.35};                       // from bottom to top, 0 to pi [rad]

  bool operator==(const BoneCamera&) const = default;
  double distance() const { return (target - eye).norm(); }  // [m]
  /// From the camera's axes (x right, y up, z towards the eye, origin at the eye) to W.
  Eigen::Isometry3d pose() const;
};

/// A camera that shows the whole of a box, with a little room around.
/// @param from   from the box's middle to the eye, any length but 0
/// @param aspect width through height of the picture
/// @throws std::invalid_argument where the box is empty or not finite.
BoneCamera looking_at(const Eigen::AlignedBox3d& box, const Eigen::Vector3d& from,
                      const Eigen::Vector3d& up, double aspect, double field_of_view = 0.35);

/// The eye goes round the target: to the right by `right`, up by `above` [rad]. Close to the poles
/// it stops.
BoneCamera orbited(const BoneCamera& camera, double right, double above);
/// Eye and target go along the picture's axes [m].
BoneCamera translated(const BoneCamera& camera, double right, double above);
/// Things become `factor` > 0 times as large in the picture, by a narrower field of view.
BoneCamera zoomed(const BoneCamera& camera, double factor);
/// The eye goes to `factor` > 0 times its distance from the target.
BoneCamera dollied(const BoneCamera& camera, double factor);

/// A stereo pair, side by side: left eye left.
struct StereoPair {
  double eye_distance{0.02};          // >= 0 [m]
  std::optional<double> convergence;  // distance without disparity > 0 [m]; else the target's
};

/// What the vertex shader needs: from W to the eye, and from there to the clip space of OpenGL.
struct EyeView {
  Eigen::Matrix4d view;
  Eigen::Matrix4d projection;
  Eigen::Vector3d eye;  // in W [m]
};

/// @param aspect  width through height of the picture
EyeView view_of(const BoneCamera& camera, double aspect);
/// An eye beside the camera's with an off-axis frustum, so that what lies at the distance of
/// convergence is at the same place in both pictures.
/// @param side  -1 left eye, +1 right eye
EyeView stereo_view_of(const BoneCamera& camera, const StereoPair& pair, int side, double aspect);

}  // namespace haptrial::render
