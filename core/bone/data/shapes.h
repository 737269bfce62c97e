#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace haptrial::bone {

/// Shapes as signed distances, below 0 inside, in millimetres. They use sums, products, quotients
/// and square roots only, so that they give the same bits on every machine.
using Point = Eigen::Vector3d;

/// Cosine and sine of an angle within [-2 pi, 2 pi] to 1e-12, by series.
struct Rotation {
  double cosine;
  double sine;
};
Rotation turn_by(double angle);

/// A cone with round ends: the balls of radius ra at a and rb at b, and what lies between them; a
/// bound of the distance, exact for equal radii.
double round_cone(const Point& p, const Point& a, const Point& b, double ra, double rb);
/// A bound of the distance to an ellipsoid along the axes; good near its surface.
double ellipsoid(const Point& p, const Point& centre, const Point& radii);
/// Union whose edge is rounded over about `width` > 0.
double smooth_union(double a, double b, double width);

/// A tube along a line through points, with a radius at each of them.
class Tube {
 public:
  struct TubeNode {
    Point at;
    double radius;
  };
  Tube() = default;
  /// @param beads  at least two.  @param least  no radius is smaller than this
  explicit Tube(std::vector<TubeNode> beads, double least = 0.0);

  /// Signed distance; where that is above `care`, maybe less, but above `care`.
  double distance(const Point& p, double care = 4.0) const;
  double length() const;
  const std::vector<TubeNode>& beads() const { return beads_; }

 private:
  std::vector<TubeNode> beads_;
  Point low_;
  Point high_;
};

/// Beads on a smooth curve through some points (Catmull-Rom), `steps` for each part.
std::vector<Tube::TubeNode> smooth(const std::vector<Tube::TubeNode>& through, int steps);
/// Beads on an arc: centre + radius (cos u + sin v), u and v unit and square to each other.
std::vector<Tube::TubeNode> arc(const Point& centre, const Point& u, const Point& v, double radius,
                                double from_degrees, double to_degrees, double tube, int steps);

/// Cells with thin walls half way between the nodes of a shaken lattice (Voronoi cells), each no
/// larger than a ball about its node.
class Cells {
 public:
  /// @param pitch  of the lattice.  @param wall  between cells
  Cells(std::uint64_t seed, double pitch, double wall) : seed_(seed), pitch_(pitch), wall_(wall) {}
  /// @param fill  from 0, none, to 1, wall to wall
  bool holds(const Point& p, double fill) const;

 private:
  std::uint64_t seed_;
  double pitch_;
  double wall_;
};

/// Noise from -1 to 1 that varies over about 1.
double noise(std::uint64_t seed, const Point& p);

}  // namespace haptrial::bone
