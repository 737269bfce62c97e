#pragma once

#include <Eigen/Core>

namespace haptrial::render {

/// A rectangle with its corners at `low` and `high`, low <= high: of pixels, or of metres in a
/// plane.
struct Rectangle {
  Eigen::Vector2d low{Eigen::Vector2d::Zero()};
  Eigen::Vector2d high{Eigen::Vector2d::Zero()};

  Eigen::Vector2d centre() const { return 0.5 * (low + high); }
  Eigen::Vector2d size() const { return high - low; }
};

/// Maps a plane in metres to pixels, with the same scale along both axes:
///
///     pixel = pixel_centre + scale (point - point_centre)
///
/// Both second axes run down the screen.
struct View {
  double scale{1.0};                                      // > 0 [px/m]
  Eigen::Vector2d point_centre{Eigen::Vector2d::Zero()};  // [m]
  Eigen::Vector2d pixel_centre{Eigen::Vector2d::Zero()};  // [px]

  Eigen::Vector2d to_pixels(const Eigen::Vector2d& point) const {
    return pixel_centre + scale * (point - point_centre);
  }
  Eigen::Vector2d to_point(const Eigen::Vector2d& pixel) const {
    return point_centre + (pixel - pixel_centre) / scale;
  }
};

/// The view that shows `world` [m] as large as fits into `screen` [px], in its middle.
/// @throws std::invalid_argument unless both sides of `screen` and a side of `world` are above
/// zero.
View fit(const Rectangle& world, const Rectangle& screen);

}  // namespace haptrial::render
