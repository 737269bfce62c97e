#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "core/contact/sweep.h"
#include "core/geometry/mesh/triangle_distance.h"

namespace haptrial::contact {
namespace {

using Eigen::Vector3d;
using geometry::Corners;

struct Graze {
  bool met;
  double y;  // of the sphere where it stops
};

/// A sphere flies past what is below the origin, `above` it at its nearest, which is a part of the
/// way that nothing but its place decides.
Graze fly_past(const Corners& c, double radius, double above, const Skin& skin) {
  const Vector3d from(0.0, -2.5 * radius, above), move(0.0, 4.0 * radius, 0.0);
  const Vector3d normal = (c[1] - c[0]).cross(c[2] - c[0]).normalized();
  Hull hull;
  hull.wrap(c, normal, 0);
  SweepHit hit;
  Vector3d apart = Vector3d::Zero();
  const Sweep sweep{from, move, radius, skin};
  if (!sweep_sphere(sweep, c, normal, hull, 1.0, hit, apart)) {
    return {false, 0.0};
  }
  return {true, from.y() + hit.t * move.y()};
}

class SweepSphereTest : public testing::TestWithParam<Corners> {};

TEST_P(SweepSphereTest, GrazesAnEdgeOrACornerWhereCirclesDo) {
  const double radius = 0.1;
  const Skin skin = Skin::of(1.0);
  const Corners& c = GetParam();
  for (int power = 1; power < 80; ++power) {
    const double part = std::pow(10.0, -0.15 * power);  // down to 1e-12
    const double over = radius * part, rest = radius + skin.rest();
    EXPECT_FALSE(fly_past(c, radius, rest + over, skin).met) << part;
    const Graze graze = fly_past(c, radius, rest - over, skin);
    if (over < 2.0 * skin.rest()) {
      continue;  // within the skin either is right
    }
    ASSERT_TRUE(graze.met) << part;
    const Vector3d at(0.0, graze.y, rest - over);
    const double off =
        std::sqrt(geometry::closest_on_triangle(at, c[0], c[1], c[2]).distance_squared);
    EXPECT_GE(off, radius + skin.thickness) << part;
    EXPECT_LE(off, rest + 1e-9 * radius) << part;
    EXPECT_LT(graze.y, 0.0) << part;
  }
}

INSTANTIATE_TEST_SUITE_P(
    EdgeAndCorner, SweepSphereTest,
    testing::Values(Corners{Vector3d(-1, 0, 0), Vector3d(1, 0, 0), Vector3d(0, 0, -1)},
                    Corners{Vector3d(0, 0, 0), Vector3d(0.3, 0.1, -1), Vector3d(-0.3, 0.1, -1)},
                    // Another part of the triangle is met before the one that is nearest first.
                    Corners{Vector3d(-1, -0.4, -0.2), Vector3d(1, 0, 0), Vector3d(-1, 0.0, 0)}));

}  // namespace
}  // namespace haptrial::contact
