#pragma once

#include <Eigen/Core>
#include <array>
#include <numbers>
#include <span>

#include "core/render/gl/colour.h"
#include "core/render/gl/image.h"

namespace haptrial::render {

/// A triangle of a solid thing, for a picture. Seen from both sides.
struct SceneTriangle {
  std::array<Eigen::Vector3d, 3> corners;  // [m]
  Colour colour;
  int hidden_edge{-1};  // the number of the corner across from an edge that is never darkened
};

/// A parallel view of the whole scene, lit from the eye.
struct SceneView {
  double azimuth{0.6};                           // around `up`; 0 looks along -z or -x [rad]
  double elevation{0.35};                        // above the horizon [rad]
  Eigen::Vector3d up{Eigen::Vector3d::UnitY()};  // any length but 0
  bool edges{false};                             // darken the triangles' edges
  int width{600};                                // [px]
  int height{420};                               // [px]
  Colour background{1.0, 1.0, 1.0};

  /// Unit length, from the scene to the eye.
  Eigen::Vector3d towards_eye() const;
};

/// The picture, as large as fits, with smooth edges: drawn off screen in OpenGL at twice the size.
/// @throws RunError when OpenGL gives no picture; std::invalid_argument when the scene is empty or
/// not finite.
Image draw_scene(std::span<const SceneTriangle> triangles, const SceneView& view);

}  // namespace haptrial::render
