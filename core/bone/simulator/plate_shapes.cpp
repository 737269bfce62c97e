#include "core/bone/simulator/plate_shapes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>

namespace haptrial::bone {
namespace {

using Eigen::Vector2d;
using geometry::Mesh;

constexpr double kTurn = 2.0 * std::numbers::pi;
constexpr int kAround = 24;  // points around a hole, and about as many around a pad

/// A point of a pad's outline; `shared` is the number of a point that belongs to a bar.
struct OutlinePoint {
  double angle;  // around the hole
  Vector2d at{Vector2d::Zero()};
  int shared{-1};
  bool bar_end{false};  // the side to the next point is the middle of a bar
};

void check_shape(const PlateShape& shape) {
  const bool sizes = shape.hole_radius > 0.0 && shape.pad_radius > shape.hole_radius &&
                     shape.bar_width > 0.0 && shape.bar_width < 2.0 * shape.pad_radius &&
                     shape.thickness > 0.0 && shape.pad_radius < 1.0 && shape.thickness < 1.0;
  if (!sizes || shape.holes.empty()) {
    throw std::invalid_argument("plate: needs a hole, and sizes above 0 that fit each other");
  }
  for (std::size_t i = 0; i < shape.holes.size(); ++i) {
    for (std::size_t j = i + 1; j < shape.holes.size(); ++j) {
      if (!((shape.holes[j] - shape.holes[i]).norm() > 2.0 * shape.pad_radius)) {
        throw std::invalid_argument("plate: pads overlap");
      }
    }
  }
}

/// Unit vectors along which bars leave hole i, with the numbers of the two points in their middle.
struct Bar {
  Vector2d along;
  double half;      // from the hole to the middle of the bar
  int left, right;  // numbers of its corners there, seen along it
};

class PlateMaker {
 public:
  explicit PlateMaker(const PlateShape& shape) : shape_(shape) {
    check_shape(shape);
    for (std::size_t i = 0; i + 1 < shape.holes.size(); ++i) {
      const Vector2d along = (shape.holes[i + 1] - shape.holes[i]).normalized();
      const Vector2d side(-along.y(), along.x());
      const Vector2d middle = 0.5 * (shape.holes[i] + shape.holes[i + 1]);
      add(middle + 0.5 * shape.bar_width * side);  // left, seen from hole i
      add(middle - 0.5 * shape.bar_width * side);
    }
    for (std::size_t i = 0; i < shape.holes.size(); ++i) {
      add_pad(i);
    }
  }

  Mesh mesh() && { return std::move(mesh_); }

 private:
  /// A point on both sides of the plate. @returns its number; at z = 0 that is vertex 2 n.
  int add(const Vector2d& at) {
    mesh_.vertices.emplace_back(at.x(), at.y(), 0.0);
    mesh_.vertices.emplace_back(at.x(), at.y(), shape_.thickness);
    return static_cast<int>(mesh_.vertices.size()) / 2 - 1;
  }
  /// A triangle of points that run anticlockwise, on both sides.
  void add_face(int a, int b, int c) {
    mesh_.triangles.push_back({2 * a + 1, 2 * b + 1, 2 * c + 1});
    mesh_.triangles.push_back({2 * a, 2 * c, 2 * b});
  }
  /// A wall over the side from a to b, the plate to its left.
  void add_wall(int a, int b) {
    mesh_.triangles.push_back({2 * a, 2 * b, 2 * b + 1});
    mesh_.triangles.push_back({2 * a, 2 * b + 1, 2 * a + 1});
  }

  std::vector<Bar> bars(std::size_t i) const {
    std::vector<Bar> all;
    const auto bar = [&](std::size_t to, std::size_t number, bool forward) {
      const Vector2d way = shape_.holes[to] - shape_.holes[i];
      const int first = 2 * static_cast<int>(number);
      all.push_back({way.normalized(), 0.5 * way.norm(), first + (forward ? 0 : 1),
                     first + (forward ? 1 : 0)});
    };
    if (i + 1 < shape_.holes.size()) {
      bar(i + 1, i, true);
    }
    if (i > 0) {
      bar(i - 1, i - 1, false);
    }
    return all;
  }

  std::vector<OutlinePoint> outline(std::size_t i) const {
    std::vector<OutlinePoint> points;
    const std::vector<Bar> all = bars(i);
    // The angle is as wide as a bar seen from the hole where it leaves the pad.
    const double wide = std::asin(0.5 * shape_.bar_width / shape_.pad_radius);
    const auto distance = [](double a, double b) { return std::abs(std::remainder(a - b, kTurn)); };
    const auto angle_of = [](const Vector2d& v) { return std::atan2(v.y(), v.x()); };
    for (const Bar& bar : all) {
      const double middle = angle_of(bar.along);
      for (const Bar& other : all) {
        if (&other != &bar && distance(angle_of(other.along), middle) < 2.0 * wide + 0.05) {
          throw std::invalid_argument("plate: the chain of holes bends too sharply");
        }
      }
      const double end = std::atan2(0.5 * shape_.bar_width, bar.half);
      points.push_back({middle - wide, on_pad(i, middle - wide)});
      points.push_back({middle - end, Vector2d::Zero(), bar.right, true});
      points.push_back({middle + end, Vector2d::Zero(), bar.left});
      points.push_back({middle + wide, on_pad(i, middle + wide)});
    }
    for (int n = 0; n < kAround; ++n) {
      const double angle = kTurn * n / kAround;
      const bool free = std::none_of(all.begin(), all.end(), [&](const Bar& bar) {
        return distance(angle, angle_of(bar.along)) < wide + 0.4 * kTurn / kAround;
      });
      if (free) {
        points.push_back({angle, on_pad(i, angle)});
      }
    }
    for (OutlinePoint& point : points) {
      point.angle -= kTurn * std::floor(point.angle / kTurn);
    }
    std::sort(points.begin(), points.end(),
              [](const OutlinePoint& a, const OutlinePoint& b) { return a.angle < b.angle; });
    return points;
  }

  Vector2d on_pad(std::size_t i, double angle) const {
    return shape_.holes[i] + shape_.pad_radius * Vector2d(std::cos(angle), std::sin(angle));
  }

  /// Rings from the outline inwards to the hole, a point of each for every point of the outline.
  void add_pad(std::size_t i) {
    const std::vector<OutlinePoint> points = outline(i);
    const std::size_t count = points.size();
    std::vector<std::array<int, 3>> rings(count);  // outline, between, hole
    for (std::size_t n = 0; n < count; ++n) {
      const Vector2d way(std::cos(points[n].angle), std::sin(points[n].angle));
      const double between = 0.5 * (shape_.hole_radius + shape_.pad_radius);
      rings[n] = {points[n].shared >= 0 ? points[n].shared : add(points[n].at),
                  add(shape_.holes[i] + between * way),
                  add(shape_.holes[i] + shape_.hole_radius * way)};
    }
    for (std::size_t n = 0; n < count; ++n) {
      const std::array<int, 3>& a = rings[n];
      const std::array<int, 3>& b = rings[(n + 1) % count];
      for (std::size_t ring = 0; ring < 2; ++ring) {
        add_face(a[ring], b[ring], b[ring + 1]);
        add_face(a[ring], b[ring + 1], a[ring + 1]);
      }
      add_wall(b[2], a[2]);
      if (!points[n].bar_end) {
        add_wall(a[0], b[0]);
      }
    }
  }

  const PlateShape& shape_;
  Mesh mesh_;
};

void append(Mesh& mesh, const Mesh& more, const Eigen::Isometry3d& pose) {
  const auto first = static_cast<std::int32_t>(mesh.vertices.size());
  for (const Eigen::Vector3d& vertex : more.vertices) {
    mesh.vertices.push_back(pose * vertex);
  }
  for (const geometry::Triangle& t : more.triangles) {
    mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  }
}

/// A closed cylinder around x in rings `step` apart.
Mesh make_rod(double length, double radius, double step) {
  Mesh mesh;
  const int rings = std::max(2, static_cast<int>(std::ceil(length / step)) + 1);
  const int around = 16;
  for (int r = 0; r < rings; ++r) {
    for (int n = 0; n < around; ++n) {
      const double angle = kTurn * n / around;
      mesh.vertices.emplace_back(length * (r / (rings - 1.0) - 0.5), radius * std::cos(angle),
                                 radius * std::sin(angle));
    }
  }
  const auto at = [&](int r, int n) { return r * around + n % around; };
  for (int r = 0; r + 1 < rings; ++r) {
    for (int n = 0; n < around; ++n) {
      mesh.triangles.push_back({at(r, n), at(r, n + 1), at(r + 1, n + 1)});
      mesh.triangles.push_back({at(r, n), at(r + 1, n + 1), at(r + 1, n)});
    }
  }
  const auto cap = static_cast<std::int32_t>(mesh.vertices.size());
  mesh.vertices.emplace_back(-0.5 * length, 0.0, 0.0);
  mesh.vertices.emplace_back(0.5 * length, 0.0, 0.0);
  for (int n = 0; n < around; ++n) {
    mesh.triangles.push_back({cap, at(0, n + 1), at(0, n)});
    mesh.triangles.push_back({cap + 1, at(rings - 1, n), at(rings - 1, n + 1)});
  }
  return mesh;
}

}  // namespace

Mesh make_plate(const PlateShape& shape) { return PlateMaker(shape).mesh(); }

PlateShape straight_miniplate(int holes, double pitch, double middle) {
  if (holes < 2 || holes > 20) {
    throw std::invalid_argument("plate: a straight plate has from 2 to 20 holes");
  }
  PlateShape shape;
  const double length = pitch * (holes - 2) + middle;
  double x = -0.5 * length;
  for (int i = 0; i < holes; ++i) {
    shape.holes.emplace_back(x, 0.0);
    x += i + 1 == holes / 2 ? middle : pitch;
  }
  return shape;
}

PlateShape l_plate(int along, int across, double pitch) {
  if (along < 1 || across < 0 || along > 20 || across > 20) {
    throw std::invalid_argument("plate: an L plate has from 1 to 20 holes along, 0 to 20 across");
  }
  PlateShape shape;
  for (int i = along - 1; i >= 0; --i) {
    shape.holes.emplace_back(pitch * i, 0.0);
  }
  for (int i = 1; i <= across; ++i) {
    shape.holes.emplace_back(0.0, pitch * i);
  }
  return shape;
}

Eigen::Isometry3d bent_at(const Eigen::Vector3d& place, double curvature) {
  Eigen::Isometry3d pose(Eigen::Translation3d{place});
  if (curvature > 0.0) {
    const double radius = 1.0 / curvature;
    const double angle = place.x() * curvature;
    pose.linear() = Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitY()).toRotationMatrix();
    pose.translation() = Eigen::Vector3d((radius + place.z()) * std::sin(angle), place.y(),
                                         (radius + place.z()) * std::cos(angle) - radius);
  }
  return pose;
}

Mesh bent(Mesh plate, double curvature) {
  for (Eigen::Vector3d& vertex : plate.vertices) {
    vertex = bent_at(vertex, curvature).translation();
  }
  return plate;
}

Mesh make_distractor(double gap) {
  if (!(gap > 0.0 && gap < 1.0)) {
    throw std::invalid_argument("plate: a distractor's gap must be above 0 and below 1 m");
  }
  PlateShape foot;
  foot.holes = {{0.0, -6e-3}, {0.0, 0.0}, {0.0, 6e-3}};
  const Mesh footplate = make_plate(foot);
  const double middle = 0.5 * gap + foot.pad_radius;
  Mesh mesh;
  for (const double side : {-1.0, 1.0}) {
    append(mesh, footplate, Eigen::Isometry3d(Eigen::Translation3d(side * middle, 0.0, 0.0)));
  }
  // The rod lies on the footplates' middle pads, sunk in by a tenth of a millimetre.
  const double radius = 1.0e-3;
  append(mesh, make_rod(2.0 * middle + 14e-3, radius, 1e-3),
         Eigen::Isometry3d(Eigen::Translation3d(0.0, 0.0, foot.thickness + radius - 1e-4)));
  return mesh;
}

}  // namespace haptrial::bone
