#include "core/contact/felt_body.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/random.h"
#include "core/geometry/mesh/procedural.h"

namespace haptrial::contact {
namespace {

using Eigen::Vector3d;
using geometry::Mesh;

TEST(FeltBodyTest, IsClosedIfEveryEdgeHasOneSideEachWay) {
  const Mesh box = geometry::make_box({0.1, 0.2, 0.3});
  EXPECT_TRUE(FeltBody(box).closed);
  EXPECT_TRUE(FeltBody(geometry::make_torus(0.04, 0.01, 20, 10)).closed);
  Mesh open = box;
  open.triangles.pop_back();
  EXPECT_FALSE(FeltBody(open).closed);
  Mesh turned = box;
  std::swap(turned.triangles[0][0], turned.triangles[0][1]);
  EXPECT_FALSE(FeltBody(turned).closed);
  Mesh twice = box;
  twice.triangles.push_back(box.triangles.front());
  EXPECT_FALSE(FeltBody(twice).closed);
}

TEST(FeltBodyTest, TheSameMeshIsPreparedOnce) {
  const SharedBody body = felt_body(geometry::make_sphere(0.02, 8));
  EXPECT_EQ(felt_body(geometry::make_sphere(0.02, 8)), body);
  const SharedBody other = felt_body(geometry::make_sphere(0.021, 8));
  EXPECT_NE(other, body);
  EXPECT_EQ(felt_body(geometry::make_sphere(0.02, 8)), body);
}

/// Near an edge or a corner the sign is that of the solid, which is a formula for a box.
TEST(FeltBodyTest, TheSignIsRightBesideEdgesAndCorners) {
  const Vector3d half(0.05, 0.1, 0.15);
  const FeltBody box(geometry::make_box(2.0 * half));
  RandomStream random(3, "beside a box");
  const Vector3d middle = box.mesh.vertices.front().cwiseAbs() - half;  // its box lies at 0 or here
  ASSERT_LT(middle.norm(), 1e-12);
  for (int i = 0; i < 20000; ++i) {
    Vector3d p;
    for (int axis = 0; axis < 3; ++axis) {
      const double side = random.below(2) == 0 ? -1.0 : 1.0;
      p[axis] = random.below(3) == 0 ? random.uniform(-1.2, 1.2) * half[axis]
                                     : side * (half[axis] + random.uniform(-0.01, 0.01));
    }
    const Vector3d out = p.cwiseAbs() - half;
    const double outside = out.cwiseMax(0.0).norm(), inside = std::min(out.maxCoeff(), 0.0);
    EXPECT_NEAR(box.distance(p).distance, outside + inside, 1e-12) << p.transpose();
  }
}

}  // namespace
}  // namespace haptrial::contact
