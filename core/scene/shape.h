#pragma once

#include <Eigen/Core>
#include <limits>
#include <variant>

namespace haptrial::scene {

/// The half of space behind a plane: its inside is where normal · (p - point) < 0.
struct HalfSpace {
  Eigen::Vector3d point{Eigen::Vector3d::Zero()};    // on the plane [m]
  Eigen::Vector3d normal{Eigen::Vector3d::UnitY()};  // away from the inside; any length above 0
};

struct Sphere {
  Eigen::Vector3d centre{Eigen::Vector3d::Zero()};  // [m]
  double radius{0.02};                              // > 0 [m]
};

struct Box {
  Eigen::Vector3d centre{Eigen::Vector3d::Zero()};        // [m]
  Eigen::Vector3d size{Eigen::Vector3d::Constant(0.04)};  // whole edges > 0 [m]
  Eigen::Vector3d turn{Eigen::Vector3d::Zero()};  // about its own direction by its length [rad]
};

/// A round bar with flat ends; endless if length is infinite.
struct Cylinder {
  Eigen::Vector3d centre{Eigen::Vector3d::Zero()};         // [m]
  Eigen::Vector3d axis{Eigen::Vector3d::UnitY()};          // any length above 0
  double radius{0.02};                                     // > 0 [m]
  double length{std::numeric_limits<double>::infinity()};  // along the axis > 0 [m]
};

using Shape = std::variant<HalfSpace, Sphere, Box, Cylinder>;

/// How far a point is from a shape's surface.
struct SurfaceDistance {
  double distance{0.0};                              // negative inside [m]
  Eigen::Vector3d normal{Eigen::Vector3d::UnitY()};  // its gradient, a unit vector out of the shape
};

/// A shape of the world W, ready to be asked on every tick; serves fields and regions.
///
/// The distance is exact (not a bound) on either side. Its gradient jumps where two parts of the
/// surface are equally near: inside a box or a capped cylinder, at a sphere's centre, on an axis.
class PlacedShape {
 public:
  /// @throws std::invalid_argument naming the parameter that breaks its bound.
  explicit PlacedShape(const Shape& shape);

  /// Servo thread: no allocation, lock, I/O or throw.
  SurfaceDistance distance(const Eigen::Vector3d& p) const noexcept;
  /// How far the point that lies deepest is from the surface; infinite for a half-space [m].
  double deepest() const noexcept;

  /// Whether p is inside or on the surface: what "until inside" asks. False if p is not finite.
  /// Servo thread.
  bool contains(const Eigen::Vector3d& p) const noexcept { return distance(p).distance <= 0.0; }

 private:
  enum class Kind { kHalfSpace, kSphere, kBox, kCylinder };

  Kind kind_{Kind::kHalfSpace};
  Eigen::Vector3d origin_{Eigen::Vector3d::Zero()};
  Eigen::Vector3d axis_{Eigen::Vector3d::UnitY()};         // normal or axis, a unit vector
  Eigen::Vector3d half_{Eigen::Vector3d::Zero()};          // of the box's edges [m]
  Eigen::Matrix3d rotation_{Eigen::Matrix3d::Identity()};  // R_WB of the box
  double radius_{0.0};
  double half_length_{0.0};
};

}  // namespace haptrial::scene
