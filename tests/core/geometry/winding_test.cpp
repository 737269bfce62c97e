#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/geometry/bvh.h"
#include "tests/core/geometry/mesh_cases.h"

namespace haptrial::geometry {
namespace {

constexpr double kExact = std::numeric_limits<double>::infinity();

/// Without every `step`-th triangle.
Mesh with_holes(Mesh mesh, std::size_t step) {
  std::vector<Triangle> kept;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    if (i % step != 0) kept.push_back(mesh.triangles[i]);
  }
  mesh.triangles = kept;
  return mesh;
}

TEST(WindingTest, IsOneInsideAClosedMeshAndZeroOutside) {
  const Bvh sphere(make_sphere(1.0, 10));
  RandomStream random(1, "points");
  for (int i = 0; i < 500; ++i) {
    const Eigen::Vector3d p = random_point(random, 1.4);
    if (std::abs(p.norm() - 1.0) < 0.01) continue;
    EXPECT_NEAR(sphere.winding_number(p, kExact), p.norm() < 1.0 ? 1.0 : 0.0, 1e-12);
    EXPECT_EQ(sphere.winds_around(p), p.norm() < 1.0);
  }
}

TEST(WindingTest, IsTheSolidAngleOfAnOpenCone) {
  // A cap of half angle a fills 2 pi (1 - cos a) of 4 pi, seen from the sphere's centre.
  Mesh mesh = make_sphere(1.0, 40);
  std::vector<Triangle> cap;
  for (const Triangle& t : mesh.triangles) {
    const Eigen::Vector3d middle =
        (mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]) / 3.0;
    if (middle.normalized().z() > 0.6) cap.push_back(t);
  }
  mesh.triangles = cap;
  EXPECT_NEAR(Bvh(mesh).winding_number({0, 0, 0}, kExact), 0.5 * (1.0 - 0.6), 0.004);
}

// What the dipoles are wrong by: winds_around() counts on less than 0.8 / accuracy².
TEST(WindingTest, DipolesStayWithinWhatTheDecisionCountsOn) {
  for (const auto& [name, mesh] : mesh_cases()) {
    SCOPED_TRACE(name);
    const Bvh bvh(mesh);
    for (const Eigen::Vector3d& p : hard_points(mesh, 80, 31)) {
      const double exact = bvh.winding_number(p, kExact);
      for (const double accuracy : {2.0, 4.0, 8.0, 16.0}) {
        EXPECT_LT(std::abs(bvh.winding_number(p, accuracy) - exact), 0.8 / (accuracy * accuracy));
      }
    }
  }
}

TEST(WindingTest, TheDecisionIsThatOfTheExactNumber) {
  const Mesh open = with_holes(make_torus(1.0, 0.4, 60, 30), 7);
  const Bvh bvh(open);
  RandomStream random(2, "points");
  int around = 0;
  for (int i = 0; i < 1500; ++i) {
    const Eigen::Vector3d p = random_point(random, 1.5);
    const double exact = bvh.winding_number(p, kExact);
    if (std::abs(exact - 0.5) < 1e-12) continue;
    EXPECT_EQ(bvh.winds_around(p), exact > 0.5);
    around += exact > 0.5 ? 1 : 0;
  }
  EXPECT_GT(around, 50);
}

}  // namespace
}  // namespace haptrial::geometry
