#include "core/contact/hull.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "core/base/random.h"
#include "core/contact/sweep.h"
#include "core/geometry/mesh/triangle_distance.h"

namespace haptrial::contact {
namespace {

using Eigen::Vector3d;
using geometry::Corners;

/// Triangles of every shape, from even ones to slivers of a millionth.
class Triangles {
 public:
  explicit Triangles(const char* name) : random_(7, name) {}

  Vector3d cube(double reach) {
    const double x = random_.uniform(-reach, reach), y = random_.uniform(-reach, reach);
    return {x, y, random_.uniform(-reach, reach)};
  }
  double uniform(double low, double high) { return random_.uniform(low, high); }
  Corners next() {
    const Vector3d a = cube(1.0), b = a + cube(1.0);
    const double high = std::pow(10.0, random_.uniform(-6.0, 0.0));
    return {a, b, a + random_.uniform(-0.3, 1.3) * (b - a) + high * cube(1.0)};
  }

 private:
  RandomStream random_;
};

Vector3d normal_of(const Corners& c) { return (c[1] - c[0]).cross(c[2] - c[0]).normalized(); }

double distance(const Vector3d& x, const Corners& c) {
  return std::sqrt(geometry::closest_on_triangle(x, c[0], c[1], c[2]).distance_squared);
}

TEST(HullTest, HoldsItsTriangleAndLittleElse) {
  Triangles triangles("hull");
  for (int i = 0; i < 20000; ++i) {
    const Corners c = triangles.next();
    Hull hull;
    hull.wrap(c, normal_of(c), i);
    const double u = triangles.uniform(0.0, 1.0), v = triangles.uniform(0.0, 1.0 - u);
    const Vector3d inside = c[0] + u * (c[1] - c[0]) + v * (c[2] - c[0]);
    const Vector3d off = triangles.cube(1.0);
    const Hull::Heights heights = hull.heights(inside, off);
    double nearest = -1.0;
    for (int k = 0; k < Hull::kPlanes; ++k) {
      ASSERT_LE(heights.at[k], 1e-15) << i << ", plane " << k;
      nearest = std::max(nearest, heights.at[k] + heights.gain[k]);
    }
    // A plane is never farther than the triangle itself.
    ASSERT_LE(nearest, distance(inside + off, c) + 1e-14) << i;
  }
}

TEST(HullTest, APointThatIsKeptApartMeetsNothing) {
  Triangles triangles("apart");
  int apart_count = 0;
  for (int i = 0; i < 20000; ++i) {
    const Corners c = triangles.next();
    Hull hull;
    hull.wrap(c, normal_of(c), i);
    const Sweep sweep{triangles.cube(1.5), triangles.cube(1.0), 0.0, Skin::of(3.0)};
    SweepHit hit;
    Vector3d apart = Vector3d::Zero();
    if (sweep_point(sweep, hull, 1.0, hit, apart) || apart.isZero(0.0)) {
      continue;
    }
    ++apart_count;
    double level = apart.dot(c[0]);
    level = std::max({level, apart.dot(c[1]), apart.dot(c[2])});
    ASSERT_NEAR(apart.norm(), 1.0, 1e-14);
    ASSERT_GT(apart.dot(sweep.from), level) << i;
    ASSERT_GT(apart.dot(sweep.from + sweep.move), level) << i;
  }
  EXPECT_GT(apart_count, 10000);
}

TEST(HullTest, ASphereStopsWhereItsDistanceIsItsRadius) {
  Triangles triangles("sphere");
  int met = 0;
  for (int i = 0; i < 40000; ++i) {
    const Corners c = triangles.next();
    const Vector3d n = normal_of(c);
    Hull hull;
    hull.wrap(c, n, i);
    const double radius = std::pow(10.0, triangles.uniform(-3.0, -0.3));
    const Vector3d from = triangles.cube(1.5);
    const Vector3d past = (c[0] + c[1] + c[2]) / 3.0 + radius * triangles.cube(1.5);
    const Sweep sweep{from, triangles.uniform(0.5, 2.0) * (past - from), radius, Skin::of(3.0)};
    if (distance(sweep.from, c) <= 1.01 * radius) {
      continue;
    }
    SweepHit hit;
    Vector3d apart;
    const bool meets = sweep_sphere(sweep, c, n, hull, 1.0, hit, apart);
    const double part = meets ? hit.t : 1.0;
    const Vector3d out =
        sweep.from - geometry::closest_on_triangle(sweep.from, c[0], c[1], c[2]).point;
    ASSERT_NEAR((apart - out.normalized()).norm(), 0.0, 1e-7) << i;
    for (int k = 0; k <= 50; ++k) {
      ASSERT_GE(distance(sweep.from + part * k / 50.0 * sweep.move, c), radius) << i;
    }
    if (meets) {
      ++met;
      const double height = hit.plane.height(sweep.from + hit.t * sweep.move);
      ASSERT_NEAR(height, 0.0, 1e-12) << i;
      // A grazing way stops a little before.
      ASSERT_LE(distance(sweep.from + hit.t * sweep.move, c), radius + 1e-9) << i;
    }
  }
  EXPECT_GT(met, 4000);
}

}  // namespace
}  // namespace haptrial::contact
