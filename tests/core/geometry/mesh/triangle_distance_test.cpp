#include "core/geometry/mesh/triangle_distance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/core/geometry/mesh/mesh_cases.h"

namespace haptrial::geometry {
namespace {

using Vector = Eigen::Matrix<long double, 3, 1>;

/// The distance by another way, in extended precision: the plane's where the foot is inside of all
/// three edges, else the least of the edges' distances, each found by ternary search.
long double slow_distance(const Vector& p, const Vector& a, const Vector& b, const Vector& c) {
  const auto to_edge = [&](const Vector& from, const Vector& to) {
    long double low = 0, high = 1;
    const auto distance = [&](long double t) { return (from + t * (to - from) - p).norm(); };
    for (int i = 0; i < 200; ++i) {
      const long double one = low + (high - low) / 3, two = high - (high - low) / 3;
      (distance(one) < distance(two) ? high : low) = distance(one) < distance(two) ? two : one;
    }
    return distance((low + high) / 2);
  };
  long double least = std::min({to_edge(a, b), to_edge(b, c), to_edge(c, a)});
  const Vector normal = (b - a).cross(c - a);
  if (normal.norm() > 0) {
    const Vector unit = normal / normal.norm();
    const Vector foot = p - unit.dot(p - a) * unit;
    const bool inside = (b - a).cross(foot - a).dot(unit) >= 0 &&
                        (c - b).cross(foot - b).dot(unit) >= 0 &&
                        (a - c).cross(foot - c).dot(unit) >= 0;
    if (inside) {
      least = std::min(least, std::abs(unit.dot(p - a)));
    }
  }
  return least;
}

TEST(TriangleDistanceTest, AgreesWithASlowWayInExtendedPrecision) {
  for (const auto& [name, mesh] : mesh_cases()) {
    SCOPED_TRACE(name);
    const auto points = hard_points(mesh, 400, 11);
    RandomStream random(12, "triangles");
    for (const Eigen::Vector3d& p : points) {
      const Triangle& t = mesh.triangles[random.below(mesh.triangles.size())];
      const Eigen::Vector3d &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]],
                            &c = mesh.vertices[t[2]];
      const ClosestPoint found = closest_on_triangle(p, a, b, c);
      const auto expected =
          static_cast<double>(slow_distance(p.cast<long double>(), a.cast<long double>(),
                                            b.cast<long double>(), c.cast<long double>()));
      const double size = std::max({p.norm(), a.norm(), b.norm(), c.norm()});
      EXPECT_NEAR(std::sqrt(found.distance_squared), expected, 1e-9 * expected + 1e-14 * size)
          << p.transpose();
      EXPECT_NEAR((found.point - p).norm(), std::sqrt(found.distance_squared), 1e-14 * size);
    }
  }
}

TEST(TriangleDistanceTest, KnowsThePartOfTheTriangle) {
  const Eigen::Vector3d a(0, 0, 0), b(4, 0, 0), c(0, 4, 0);
  const auto part = [&](double x, double y, double z) {
    return closest_on_triangle({x, y, z}, a, b, c).part;
  };
  EXPECT_EQ(part(1, 1, 3), TrianglePart::kFace);
  EXPECT_EQ(part(2, -1, 1), TrianglePart::kEdge0);
  EXPECT_EQ(part(3, 3, 1), TrianglePart::kEdge1);
  EXPECT_EQ(part(-1, 2, 1), TrianglePart::kEdge2);
  EXPECT_EQ(part(-1, -1, 1), TrianglePart::kCorner0);
  EXPECT_EQ(part(6, 0, 1), TrianglePart::kCorner1);
  EXPECT_EQ(part(0, 7, 1), TrianglePart::kCorner2);
}

TEST(TriangleDistanceTest, ACornerIsReturnedToTheBit) {
  const Eigen::Vector3d a(0.1, 0.2, 0.3), b(0.7, 0.2, 0.1), c(0.3, 0.9, 0.4);
  EXPECT_EQ(closest_on_triangle(b + Eigen::Vector3d(1, -1, -1), a, b, c).point, b);
  EXPECT_EQ(closest_on_triangle(c, a, b, c).point, c);
  EXPECT_EQ(closest_on_triangle(c, a, b, c).distance_squared, 0.0);
}

}  // namespace
}  // namespace haptrial::geometry
