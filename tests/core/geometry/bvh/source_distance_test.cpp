#include "tests/support/references/source_distance.h"

#include <gtest/gtest.h>

#include "tests/core/geometry/mesh/mesh_cases.h"

namespace haptrial::geometry {
namespace {

constexpr SourceDistance::Options kWays[] = {{-1, true},  {0, true},  {1, true},  {4, true},
                                             {-1, false}, {0, false}, {2, false}, {99, false}};

TEST(SourceDistanceTest, FindsTheSameDistancesInEveryWay) {
  for (const auto& [name, mesh] : mesh_cases()) {
    SCOPED_TRACE(name);
    const Bvh bvh(mesh);
    SourceDistance source(mesh);
    for (const auto& way : kWays) {
      source.start(way);
      for (const Eigen::Vector3d& point : hard_points(mesh, 120, 41)) {
        // Triangles equally near may differ; their distance may not.
        const double expected = bvh.closest(point).distance_squared;
        const double tolerance = 1e-24 * point.squaredNorm();
        ASSERT_NEAR(source.closest(point).distance_squared, expected, 1e-11 * expected + tolerance);
      }
    }
  }
}

/// A walk through the middle of a sphere, in small steps.
std::uint64_t triangles_tested(const SourceDistance::Options& way) {
  SourceDistance source(make_sphere(1.0, 20));
  source.start(way);
  for (int i = 0; i < 400; ++i) {
    source.closest({-0.9 + 0.0045 * i, 0.3, 0.2});
  }
  return source.counts().triangles;
}

TEST(SourceDistanceTest, ASeedSavesWork) {
  EXPECT_LT(triangles_tested({0, true}), triangles_tested({-1, true}));
}

TEST(SourceDistanceTest, WithoutTrianglesThereIsNoAnswer) {
  SourceDistance source(Mesh{});
  EXPECT_EQ(source.closest({0, 0, 0}).triangle, -1);
}

}  // namespace
}  // namespace haptrial::geometry
