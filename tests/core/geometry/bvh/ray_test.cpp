#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "core/geometry/bvh/bvh.h"
#include "tests/core/geometry/mesh/mesh_cases.h"

namespace haptrial::geometry {
namespace {

/// A cube of side 2 around the origin whose faces are divided into n x n squares of two triangles.
Mesh divided_cube(int n) {
  Mesh mesh;
  for (int face = 0; face < 6; ++face) {
    const int axis = face / 2;
    const double side = face % 2 == 0 ? -1.0 : 1.0;
    const auto first = static_cast<std::int32_t>(mesh.vertices.size());
    for (int u = 0; u <= n; ++u) {
      for (int v = 0; v <= n; ++v) {
        Eigen::Vector3d corner;
        corner[axis] = side;
        corner[(axis + 1) % 3] = -1.0 + 2.0 * u / n;
        corner[(axis + 2) % 3] = -1.0 + 2.0 * v / n;
        mesh.vertices.push_back(corner);
      }
    }
    for (int u = 0; u < n; ++u) {
      for (int v = 0; v < n; ++v) {
        const std::int32_t a = first + u * (n + 1) + v, b = a + n + 1, c = b + 1, d = a + 1;
        Triangle one{a, b, c}, two{a, c, d};
        if (side < 0.0) {
          std::swap(one[1], one[2]);
          std::swap(two[1], two[2]);
        }
        mesh.triangles.insert(mesh.triangles.end(), {one, two});
      }
    }
  }
  return mesh;
}

TEST(RayTest, CrossesACubeOnceInAndOnceOutAlsoAlongItsSeams) {
  const Bvh bvh(divided_cube(4));
  std::vector<RayHit> hits;
  // Lines through corners, edges and diagonals of the squares, along the axes and askew.
  for (int u = -7; u <= 7; ++u) {
    for (int v = -7; v <= 7; ++v) {
      for (const Eigen::Vector3d& direction :
           {Eigen::Vector3d(0, 0, 1), Eigen::Vector3d(0, 0, -2), Eigen::Vector3d(0.5, 0, 1),
            Eigen::Vector3d(0.25, 0.25, -1)}) {
        const Eigen::Vector3d through(u / 8.0, v / 8.0, 0.0);
        bvh.all_hits({through - 8.0 * direction, direction}, hits);
        ASSERT_EQ(hits.size(), 2u) << through.transpose() << " along " << direction.transpose();
        EXPECT_TRUE(hits[0].entering);
        EXPECT_FALSE(hits[1].entering);
        EXPECT_LT(hits[0].t, hits[1].t);
      }
    }
  }
}

TEST(RayTest, GivesWhatEveryTriangleGives) {
  for (const auto& [name, mesh] : mesh_cases()) {
    SCOPED_TRACE(name);
    const Bvh bvh(mesh);
    std::vector<Bvh> alone;
    const std::size_t step = std::max<std::size_t>(1, mesh.triangles.size() / 60);
    std::vector<std::int32_t> numbers;
    for (std::size_t i = 0; i < mesh.triangles.size(); i += step) {
      alone.emplace_back(Mesh{mesh.vertices, {mesh.triangles[i]}}, BvhOptions{.threads = 1});
      numbers.push_back(static_cast<std::int32_t>(i));
    }
    const auto from = hard_points(mesh, 64, 21), to = hard_points(mesh, 64, 22);
    std::vector<RayHit> hits, of_one;
    for (std::size_t i = 0; i < from.size(); ++i) {
      const Eigen::Vector3d direction = to[(i + 5) % to.size()] - from[i];
      if (direction.isZero(0.0)) {
        continue;
      }
      const Ray ray{from[i], direction};
      bvh.all_hits(ray, hits);
      for (std::size_t k = 0; k < alone.size(); ++k) {
        alone[k].all_hits(ray, of_one);
        const auto found = std::find_if(hits.begin(), hits.end(), [&](const RayHit& hit) {
          return hit.triangle == numbers[k];
        });
        ASSERT_EQ(of_one.empty(), found == hits.end());
        if (!of_one.empty()) {
          EXPECT_EQ(of_one[0].t, found->t);
        }
      }
      const auto nearest = bvh.nearest_hit(ray);
      ASSERT_EQ(nearest.has_value(), !hits.empty());
      if (nearest) {
        EXPECT_EQ(nearest->t, hits[0].t);
      }
    }
  }
}

TEST(RayTest, EndsAndBeginningsCount) {
  const Bvh bvh(make_sphere(1.0, 10));
  const auto hit = [&](double begin, double end) {
    return bvh.nearest_hit({{-3, 0.1, 0.2}, {1, 0, 0}, begin, end});
  };
  ASSERT_TRUE(hit(0.0, 10.0));
  EXPECT_TRUE(hit(0.0, 10.0)->entering);
  EXPECT_NEAR(hit(0.0, 10.0)->t, 3.0 - std::sqrt(1.0 - 0.05), 0.01);
  ASSERT_TRUE(hit(3.0, 10.0));
  EXPECT_FALSE(hit(3.0, 10.0)->entering);
  EXPECT_FALSE(hit(0.0, 1.0));
  EXPECT_FALSE(hit(5.0, 10.0));
  EXPECT_FALSE(bvh.nearest_hit({{-3, 0, 0}, {0, 0, 0}}));
}

TEST(RayTest, ParityTellsInsideFromOutside) {
  RandomStream random(1, "points");
  const Bvh sphere(make_sphere(1.0, 12));
  const Bvh torus(make_torus(1.0, 0.4, 40, 20));
  int inside = 0;
  for (int i = 0; i < 4000; ++i) {
    const Eigen::Vector3d p = random_point(random, 1.5);
    if (std::abs(p.norm() - 1.0) > 0.01) {
      EXPECT_EQ(sphere.contains(p), p.norm() < 1.0);
    }
    const double tube = std::hypot(std::hypot(p.x(), p.y()) - 1.0, p.z());
    if (std::abs(tube - 0.4) > 0.02) {
      EXPECT_EQ(torus.contains(p), tube < 0.4) << p.transpose();
      inside += tube < 0.4 ? 1 : 0;
    }
  }
  EXPECT_GT(inside, 100);
}

}  // namespace
}  // namespace haptrial::geometry
