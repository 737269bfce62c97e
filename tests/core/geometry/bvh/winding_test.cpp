#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/geometry/bvh/bvh.h"
#include "tests/core/geometry/mesh/mesh_cases.h"

namespace haptrial::geometry {
namespace {

constexpr double kExact = std::numeric_limits<double>::infinity();

/// The mesh without every `step`-th triangle.
Mesh with_holes(Mesh mesh, std::size_t step) {
  std::vector<Triangle> kept;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    if (i % step != 0) {
      kept.push_back(mesh.triangles[i]);
    }
  }
  mesh.triangles = kept;
  return mesh;
}

TEST(WindingTest, IsOneInsideAClosedMeshAndZeroOutside) {
  const Bvh sphere(make_sphere(1.0, 10));
  RandomStream random(1, "points");
  for (int i = 0; i < 500; ++i) {
    const Eigen::Vector3d p = random_point(random, 1.4);
    if (std::abs(p.norm() - 1.0) < 0.01) {
      continue;
    }
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
    if (middle.normalized().z() > 0.6) {
      cap.push_back(t);
    }
  }
  mesh.triangles = cap;
  EXPECT_NEAR(Bvh(mesh).winding_number({0, 0, 0}, kExact), 0.5 * (1.0 - 0.6), 0.004);
}

// The far field of a closed or open surface: an error of first order in radius over distance.
TEST(WindingTest, DipolesGetBetterWithAccuracy) {
  const Bvh bvh(with_holes(make_rough_solid(1.0, 24, 3), 5));
  RandomStream random(3, "points");
  double worst[3] = {0.0, 0.0, 0.0};
  for (int i = 0; i < 300; ++i) {
    const Eigen::Vector3d p = random_point(random, 0.7);
    const double exact = bvh.winding_number(p, kExact);
    for (int k = 0; k < 3; ++k) {
      const double found = bvh.winding_number(p, 2 << (2 * k));
      worst[k] = std::max(worst[k], std::abs(found - exact));
    }
  }
  EXPECT_LT(worst[0], 0.05);
  EXPECT_LT(worst[1], 0.5 * worst[0]);
  EXPECT_LT(worst[2], 0.5 * worst[1]);
}

TEST(WindingTest, TheDecisionIsThatOfTheExactNumber) {
  int around = 0;
  const auto check = [&](const Mesh& mesh, const std::vector<Eigen::Vector3d>& points) {
    const Bvh bvh(mesh);
    for (const Eigen::Vector3d& p : points) {
      const double exact = bvh.winding_number(p, kExact);
      if (std::abs(exact - 0.5) < 1e-9) {
        continue;
      }
      EXPECT_EQ(bvh.winds_around(p), exact > 0.5) << p.transpose();
      around += exact > 0.5 ? 1 : 0;
    }
  };
  const Mesh open = with_holes(make_torus(1.0, 0.4, 60, 30), 7);
  check(open, hard_points(open, 1500, 2));
  for (const auto& [name, mesh] : mesh_cases()) {
    SCOPED_TRACE(name);
    check(mesh, hard_points(mesh, 80, 31));
  }
  EXPECT_GT(around, 100);
}

}  // namespace
}  // namespace haptrial::geometry
