#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>

namespace haptrial::bone {

/// How a ball bends the surface of a soft structure, in the bone's frame: a place x of it goes by
///
///     -d (1 - |x - p|² / w²)² out,   w² = 12.5 r |d|
///
/// with the place p at rest that is nearest to the ball's centre. A flat surface then lies on the
/// ball there, and outside of it everywhere else. Plain data: a part of a view.
struct Dent {
  std::uint8_t label{0};                           // of the structure
  Eigen::Vector3d place{Eigen::Vector3d::Zero()};  // p [m]
  Eigen::Vector3d out{Eigen::Vector3d::Zero()};    // unit, out of the tissue
  double depth{0.0};                               // d; below 0: pulled out; 0: no dent [m]
  double radius{0.0};                              // r of the ball [m]

  double width() const noexcept { return std::sqrt(12.5 * radius * std::abs(depth)); }
  /// Box around all that the dent moves, before and after; empty for no dent.
  Eigen::AlignedBox3d bounds() const noexcept {
    Eigen::AlignedBox3d box;
    if (depth != 0.0) {
      const Eigen::Vector3d around = Eigen::Vector3d::Constant(width() + std::abs(depth));
      box.extend(Eigen::Vector3d(place - around));
      box.extend(Eigen::Vector3d(place + around));
    }
    return box;
  }
  bool operator==(const Dent&) const = default;
};

}  // namespace haptrial::bone
