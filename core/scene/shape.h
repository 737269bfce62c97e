#pragma once

#include <Eigen/Core>
#include <limits>
#include <memory>
#include <variant>

namespace haptrial::scene {

/// How far a point is from a shape's surface.
struct SurfaceDistance {
  double distance{0.0};                              // negative inside [m]
  Eigen::Vector3d normal{Eigen::Vector3d::UnitY()};  // a unit vector out of the shape
  double slope{1.0};  // length of the distance's gradient, which is along the normal
};

/// A ball that stands for a shape in pictures.
struct ShapeBall {
  Eigen::Vector3d centre{Eigen::Vector3d::Zero()};  // [m]
  double radius{0.0};                               // 0: a point [m]
};

/// The half of space behind a plane: its inside is where normal · (p - point) < 0.
struct HalfSpace {
  Eigen::Vector3d point{Eigen::Vector3d::Zero()};    // on the plane [m]
  Eigen::Vector3d normal{Eigen::Vector3d::UnitY()};  // away from the inside; any length above 0

  ShapeBall ball() const { return {point, 0.0}; }
  /// A place to aim at, inside [m]; so of every shape.
  Eigen::Vector3d inside() const { return point - 0.01 * normal.normalized(); }
};

struct Sphere {
  Eigen::Vector3d centre{Eigen::Vector3d::Zero()};  // [m]
  double radius{0.02};                              // > 0 [m]

  ShapeBall ball() const { return {centre, radius}; }
  Eigen::Vector3d inside() const { return centre; }
};

struct Box {
  Eigen::Vector3d centre{Eigen::Vector3d::Zero()};        // [m]
  Eigen::Vector3d size{Eigen::Vector3d::Constant(0.04)};  // whole edges > 0 [m]
  Eigen::Vector3d turn{Eigen::Vector3d::Zero()};  // about its own direction by its length [rad]

  ShapeBall ball() const { return {centre, 0.5 * size.maxCoeff()}; }
  Eigen::Vector3d inside() const { return centre; }
};

/// A round bar with flat ends; endless if length is infinite.
struct Cylinder {
  Eigen::Vector3d centre{Eigen::Vector3d::Zero()};         // [m]
  Eigen::Vector3d axis{Eigen::Vector3d::UnitY()};          // any length above 0
  double radius{0.02};                                     // > 0 [m]
  double length{std::numeric_limits<double>::infinity()};  // along the axis > 0 [m]

  ShapeBall ball() const { return {centre, radius}; }
  Eigen::Vector3d inside() const { return centre; }
};

/// A shape that is made outside of the program: its numbers are in W [m], it does not change, and
/// several servo threads may ask it at once.
class ShapeLaw {
 public:
  virtual ~ShapeLaw() = default;
  /// Distance and normal as PlacedShape has them. One that is not finite counts as far outside.
  /// Servo thread: no allocation, lock, I/O or throw, and done in a few microseconds.
  virtual SurfaceDistance distance(const Eigen::Vector3d& p) const noexcept = 0;
  /// How far the point that lies deepest is from the surface > 0 [m]. Over the last 2 mm before
  /// it a surface's force fades.
  virtual double deepest() const noexcept = 0;
  virtual ShapeBall ball() const = 0;
  virtual Eigen::Vector3d inside() const = 0;
};

struct RegisteredShape {
  std::shared_ptr<const ShapeLaw> law;  // not null

  ShapeBall ball() const { return law->ball(); }
  Eigen::Vector3d inside() const { return law->inside(); }
};

using Shape = std::variant<HalfSpace, Sphere, Box, Cylinder, RegisteredShape>;

inline ShapeBall ball_of(const Shape& shape) {
  return std::visit([](const auto& each) { return each.ball(); }, shape);
}
inline Eigen::Vector3d place_inside(const Shape& shape) {
  return std::visit([](const auto& each) -> Eigen::Vector3d { return each.inside(); }, shape);
}

/// A shape of the world W, ready to be asked on every tick; serves fields and regions.
///
/// The distance of a shipped shape is exact (not a bound) on either side. Its gradient jumps where
/// two parts of the surface are equally near: inside a box or a capped cylinder, at a sphere's
/// centre, on an axis.
class PlacedShape {
 public:
  /// @throws std::invalid_argument naming the parameter that breaks its bound.
  explicit PlacedShape(const Shape& shape);

  /// @param rounding  greatest width over which the gradient turns between two parts of the
  ///                  surface inside a box or cylinder; it is 0 on the surface and in the middle.
  ///                  0: it jumps, and the distance is exact [m]
  /// Servo thread: no allocation, lock, I/O or throw.
  SurfaceDistance distance(const Eigen::Vector3d& p, double rounding = 0.0) const noexcept;
  /// How far the point that lies deepest is from the surface; infinite for a half-space [m].
  double deepest() const noexcept;

  /// Whether p is inside or on the surface: what "until inside" asks. False if p is not finite.
  /// Servo thread.
  bool contains(const Eigen::Vector3d& p) const noexcept { return distance(p).distance <= 0.0; }

 private:
  enum class Kind { kHalfSpace, kSphere, kBox, kCylinder, kRegistered };

  Kind kind_{Kind::kHalfSpace};
  Eigen::Vector3d origin_{Eigen::Vector3d::Zero()};
  Eigen::Vector3d axis_{Eigen::Vector3d::UnitY()};         // normal or axis, a unit vector
  Eigen::Vector3d half_{Eigen::Vector3d::Zero()};          // of the box's edges [m]
  Eigen::Matrix3d rotation_{Eigen::Matrix3d::Identity()};  // R_WB of the box
  double radius_{0.0};
  double half_length_{0.0};
  std::shared_ptr<const ShapeLaw> law_;
};

}  // namespace haptrial::scene
