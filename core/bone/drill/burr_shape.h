#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <numbers>
#include <span>
#include <vector>

namespace haptrial::bone {

enum class BurrForm : std::uint8_t {
  kBall,
  kCylinder,  // a fissure burr, with flat ends
  kCone,      // a taper, with flat ends, narrow at its tip
  kPear,      // the hull of two balls, narrow at its neck; a cylinder with round ends if it is not
  kRod,    // a cylinder whose ends are within other parts: a shaft, which pushes by its side only
  kBlade,  // a flat box: x along its width, y across it; a saw's teeth, and the sheet behind them
};

/// Volume of a ball over diameter^3.
inline constexpr double kBallFullness = std::numbers::pi / 6.0;

struct BurrDimensions {
  BurrForm form{BurrForm::kBall};
  double diameter{4e-3};        // the greatest > 0; a blade's width [m]
  double length{0.0};           // along the axis > 0, a pear's above its diameter; no ball's [m]
  double narrow_diameter{0.0};  // of a cone's tip >= 0 or a pear's neck > 0, <= diameter; a
                                // blade's thickness > 0 [m]
};

/// A convex solid of revolution about the z axis of the tool frame T (core/base/tool_state.h), or a
/// blade; the middle of its length is T's origin, and its tip is at negative z. Immutable: any
/// thread. The source has balls only: Morris 2006, §3.2.3.6.
class BurrShape {
 public:
  /// @throws std::invalid_argument naming the dimension that breaks its bound.
  explicit BurrShape(const BurrDimensions& dimensions);

  const BurrDimensions& dimensions() const noexcept { return dimensions_; }
  bool is_ball() const noexcept { return dimensions_.form == BurrForm::kBall; }
  /// Whether -p lies in it with every p.
  bool is_point_symmetric() const noexcept;
  double half_length() const noexcept { return half_length_; }  // [m]
  double reach() const noexcept { return reach_; }              // of its points from the origin [m]
  double fullness() const noexcept { return fullness_; }        // volume / diameter^3
  double volume() const noexcept;                               // [m^3]
  /// Radius of the ball with the same volume [m].
  double ball_radius() const noexcept;
  /// Radius of its section at a height; half of a blade's width; 0 beyond its ends [m].
  double radius_at(double z) const noexcept;

  struct Nearest {
    double distance;         // of its surface, negative within [m]
    Eigen::Vector3d normal;  // outward, unit length, of the surface at the nearest point
  };
  /// No allocation, lock or throw.
  Nearest nearest(const Eigen::Vector3d& p_T) const noexcept;

  /// A ball within it, its centre on the axis.
  struct Ball {
    double z;       // [m]
    double radius;  // [m]
  };
  /// Balls that fill it but for its edges, for what knows balls only; of a ball itself.
  std::span<const Ball> balls() const noexcept { return balls_; }

  struct OutlinePoint {
    double radius;   // from the axis [m]
    double z;        // [m]
    double lateral;  // component of the normal across the axis, 0 to 1; of a flat end its edge's
  };
  /// The shape's meridian from the tip to the other end: a polyline for each smooth part, with the
  /// arcs in `steps` chords. A blade has none.
  std::vector<std::vector<OutlinePoint>> outline(int steps) const;

 private:
  /// A straight line from a to b, or an arc around a point of the axis.
  struct Piece {
    Eigen::Vector2d a;       // (radius, z), towards the tip
    Eigen::Vector2d b;       //
    Eigen::Vector2d normal;  // of a line
    double arc_z{0.0};       // of an arc's centre
    double arc_radius{0.0};  // 0: a line
    bool pushes{true};       // else it is no part of the surface
    bool is_flat_end() const { return arc_radius == 0.0 && normal.x() == 0.0; }
  };
  void add_line(const Eigen::Vector2d& a, const Eigen::Vector2d& b, bool pushes = true);
  void add_arc(const Eigen::Vector2d& a, const Eigen::Vector2d& b, double z, double radius);
  void add_pear();
  Nearest nearest_of_box(const Eigen::Vector3d& p_T) const noexcept;
  void measure();
  void fill_with_balls();

  BurrDimensions dimensions_;
  std::vector<Piece> pieces_;
  std::vector<Ball> balls_;
  double half_length_{0.0};
  double reach_{0.0};
  double fullness_{0.0};
};

}  // namespace haptrial::bone
