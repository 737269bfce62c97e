#include "core/geometry/volume/distance_map.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "core/geometry/mesh/triangle_distance.h"
#include "core/geometry/volume/voxelize.h"
#include "tests/core/geometry/mesh/mesh_cases.h"
#include "tests/support/references/pseudonormals.h"

namespace haptrial::geometry {
namespace {

VoxelSolid solid_of(const Mesh& mesh, int resolution, int margin = 0) {
  return voxelize(mesh, make_grid(bounds(mesh), resolution, margin), fitting_rule(mesh));
}

ClosestPoint brute_force(const Mesh& mesh, const Eigen::Vector3d& point) {
  ClosestPoint best;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const Triangle& t = mesh.triangles[i];
    ClosestPoint here =
        closest_on_triangle(point, mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]);
    if (!(here.distance_squared < best.distance_squared)) {
      continue;
    }
    best = here;
    best.triangle = static_cast<std::int32_t>(i);
  }
  return best;
}

template <class Visit>
void for_each_voxel(const VoxelGrid& grid, Visit visit) {
  for (std::int32_t k = 0; k < grid.size[2]; ++k) {
    for (std::int32_t j = 0; j < grid.size[1]; ++j) {
      for (std::int32_t i = 0; i < grid.size[0]; ++i) {
        visit(grid.index(i, j, k), grid.centre(i, j, k));
      }
    }
  }
}

TEST(DistanceMapTest, IsBruteForceAtEveryVoxel) {
  for (const Mesh& mesh : {make_gear(), make_torus(1.0, 0.3, 24, 12), make_rough_solid(1.0, 6, 3),
                           moved(make_sphere(1.0, 4), 1e-6, {1.0, 1.0, 1.0})}) {
    const VoxelSolid solid = solid_of(mesh, 13, 2);
    const DistanceMap map = make_distance_map(Bvh(mesh), solid, {.everywhere = true});
    int inside = 0;
    for_each_voxel(solid.grid, [&](std::size_t voxel, const Eigen::Vector3d& centre) {
      const ClosestPoint expected = brute_force(mesh, centre);
      const bool is_inside = solid.labels[voxel] == VoxelLabel::kInside;
      const double distance = std::sqrt(expected.distance_squared);
      ASSERT_EQ(map.distance[voxel], is_inside ? -distance : distance);
      ASSERT_EQ(map.point[voxel], expected.point);
      ASSERT_EQ(map.triangle[voxel], expected.triangle);
      inside += is_inside ? 1 : 0;
    });
    EXPECT_GT(inside, 50);
  }
}

TEST(DistanceMapTest, LeavesTheOutsideAlone) {
  const Mesh mesh = make_gear();
  const VoxelSolid solid = solid_of(mesh, 40);
  const DistanceMap inside = make_distance_map(Bvh(mesh), solid);
  const DistanceMap all = make_distance_map(Bvh(mesh), solid, {.everywhere = true});
  for (std::size_t i = 0; i < solid.labels.size(); ++i) {
    if (solid.labels[i] == VoxelLabel::kInside) {
      EXPECT_EQ(inside.distance[i], all.distance[i]);
      EXPECT_EQ(inside.triangle[i], all.triangle[i]);
    } else {
      EXPECT_TRUE(std::isnan(inside.distance[i]));
      EXPECT_TRUE(std::isnan(inside.point[i].x()));
      EXPECT_EQ(inside.triangle[i], -1);
      EXPECT_GE(all.distance[i], 0.0);
    }
  }
}

template <class T>
bool same_bytes(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

TEST(DistanceMapTest, HasTheSameBytesOnAnyThreadsAndInstructionSet) {
  const Mesh mesh = make_rough_solid(1.0, 20, 5);
  const VoxelSolid solid = solid_of(mesh, 37, 1);
  const DistanceMap one =
      make_distance_map(Bvh(mesh, {.threads = 1, .instruction_set = InstructionSet::kBaseline}),
                        solid, {.everywhere = true, .threads = 1});
  for (const InstructionSet set : available_instruction_sets()) {
    SCOPED_TRACE(name_of(set));
    const DistanceMap other = make_distance_map(Bvh(mesh, {.threads = 3, .instruction_set = set}),
                                                solid, {.everywhere = true, .threads = 4});
    EXPECT_TRUE(same_bytes(one.distance, other.distance));
    EXPECT_TRUE(same_bytes(one.point, other.point));
    EXPECT_TRUE(same_bytes(one.triangle, other.triangle));
  }
}

// A distance changes by no more than the way from one place to the next.
TEST(DistanceMapTest, IsLipschitzAcrossTheSurface) {
  const Mesh mesh = make_rough_solid(1.0, 16, 9);
  const VoxelSolid solid = solid_of(mesh, 48, 1);
  const DistanceMap map =
      make_distance_map(Bvh(mesh), solid, {.everywhere = true, .points = false});
  EXPECT_TRUE(map.point.empty());
  const VoxelGrid& grid = map.grid;
  for (std::int32_t k = 0; k < grid.size[2]; ++k) {
    for (std::int32_t j = 0; j < grid.size[1]; ++j) {
      for (std::int32_t i = 1; i < grid.size[0]; ++i) {
        const double step =
            map.distance[grid.index(i, j, k)] - map.distance[grid.index(i - 1, j, k)];
        EXPECT_LE(std::abs(step), grid.spacing * (1.0 + 1e-9));
      }
    }
  }
}

TEST(DistanceMapTest, ReportsAndStops) {
  const Mesh mesh = make_sphere(1.0, 8);
  const VoxelSolid solid = solid_of(mesh, 60);
  std::vector<double> shares;
  make_distance_map(Bvh(mesh), solid, {}, [&](double share) {
    shares.push_back(share);
    return true;
  });
  EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
  EXPECT_EQ(shares.back(), 1.0);
  EXPECT_THROW(make_distance_map(Bvh(mesh), solid, {}, [](double) { return false; }), Cancelled);
  EXPECT_THROW(make_distance_map(Bvh(mesh), {solid.grid, {}}), std::invalid_argument);
}

TEST(DistanceMapTest, OfNoTrianglesHasNoNumbers) {
  const VoxelSolid solid = solid_of(make_sphere(1.0, 2), 5);
  const DistanceMap map = make_distance_map(Bvh(Mesh{}), solid, {.everywhere = true});
  for (const double distance : map.distance) {
    EXPECT_TRUE(std::isnan(distance));
  }
}

TEST(PseudonormalTest, SignsAgreeWithParity) {
  for (const Mesh& mesh :
       {make_gear(), make_torus(1.0, 0.3, 24, 12), make_rough_solid(1.0, 8, 3)}) {
    const Bvh bvh(mesh);
    const Pseudonormals normals(mesh);
    RandomStream random(4, "points");
    int inside = 0, beside_edges = 0;
    for (int i = 0; i < 4000; ++i) {
      const Eigen::Vector3d p =
          bounds(mesh).center() + random_point(random, 0.6 * bounds(mesh).sizes().maxCoeff());
      const ClosestPoint nearest = bvh.closest(p);
      if (nearest.distance_squared < 1e-20) {
        continue;
      }
      const double distance = normals.signed_distance(p, nearest);
      EXPECT_EQ(distance < 0.0, bvh.contains(p)) << p.transpose();
      EXPECT_DOUBLE_EQ(distance * distance, nearest.distance_squared);
      inside += distance < 0.0 ? 1 : 0;
      beside_edges += nearest.part != TrianglePart::kFace ? 1 : 0;
    }
    EXPECT_GT(inside, 50);
    EXPECT_GT(beside_edges, 500);
  }
}

// The tetrahedron is so sharp that one face's own normal would call points beyond its tip inside.
TEST(PseudonormalTest, SharpCornersKeepTheirSign) {
  const Mesh mesh{{{0, 0, 0}, {10, 0.1, 0}, {10, -0.1, 0.1}, {10, -0.1, -0.1}},
                  {{0, 2, 1}, {0, 3, 2}, {0, 1, 3}, {1, 2, 3}}};
  const Bvh bvh(mesh);
  const Pseudonormals normals(mesh);
  ASSERT_TRUE(bvh.contains({5, 0, 0}));
  EXPECT_LT(normals.signed_distance({9, 0, 0}, bvh.closest({9, 0, 0})), 0.0);
  RandomStream random(5, "points");
  for (int i = 0; i < 1000; ++i) {
    const Eigen::Vector3d p = Eigen::Vector3d(-0.05, 0, 0) + random_point(random, 0.04);
    const ClosestPoint nearest = bvh.closest(p);
    EXPECT_EQ(nearest.part >= TrianglePart::kCorner0, true);
    EXPECT_GT(normals.signed_distance(p, nearest), 0.0);
  }
}

}  // namespace
}  // namespace haptrial::geometry
