#include "core/geometry/bvh.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/base/error.h"
#include "core/geometry/triangle_distance.h"
#include "tests/core/geometry/mesh_cases.h"

namespace haptrial::geometry {
namespace {

ClosestPoint brute_force(const Mesh& mesh, const Eigen::Vector3d& point) {
  ClosestPoint best;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const Triangle& t = mesh.triangles[i];
    ClosestPoint here =
        closest_on_triangle(point, mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]);
    if (here.distance_squared < best.distance_squared) {
      best = here;
      best.triangle = static_cast<std::int32_t>(i);
    }
  }
  return best;
}

void expect_same(const ClosestPoint& found, const ClosestPoint& expected) {
  EXPECT_EQ(found.distance_squared, expected.distance_squared);
  EXPECT_EQ(found.triangle, expected.triangle);
  EXPECT_EQ(found.part, expected.part);
  EXPECT_EQ(found.point, expected.point);
}

constexpr int kPoints = 800;  // of each case

TEST(BvhTest, FindsWhatBruteForceFinds) {
  for (const MeshCase& mesh_case : mesh_cases()) {
    SCOPED_TRACE(mesh_case.name);
    const Bvh bvh(mesh_case.mesh);
    for (const Eigen::Vector3d& point : hard_points(mesh_case.mesh, kPoints, 1)) {
      SCOPED_TRACE(::testing::Message() << point.transpose());
      expect_same(bvh.closest(point), brute_force(mesh_case.mesh, point));
      if (::testing::Test::HasFailure()) return;
    }
  }
}

TEST(BvhTest, AHintDoesNotChangeTheAnswer) {
  RandomStream random(2, "hints");
  for (const MeshCase& mesh_case : mesh_cases()) {
    SCOPED_TRACE(mesh_case.name);
    const Bvh bvh(mesh_case.mesh);
    for (const Eigen::Vector3d& point : hard_points(mesh_case.mesh, kPoints, 2)) {
      const auto hint = static_cast<std::int32_t>(random.below(bvh.triangles()));
      expect_same(bvh.closest(point, hint), bvh.closest(point));
      if (::testing::Test::HasFailure()) return;
    }
  }
}

TEST(BvhTest, ManyPointsGetTheAnswersOfEach) {
  for (const MeshCase& mesh_case : mesh_cases()) {
    SCOPED_TRACE(mesh_case.name);
    const Bvh bvh(mesh_case.mesh);
    std::vector<Eigen::Vector3d> points = hard_points(mesh_case.mesh, 3 * kPoints + 5, 3);
    points[7].y() = std::numeric_limits<double>::quiet_NaN();
    std::vector<ClosestPoint> answers(points.size());
    bvh.closest(points, answers);
    for (std::size_t i = 0; i < points.size(); ++i) {
      SCOPED_TRACE(i);
      expect_same(answers[i], bvh.closest(points[i]));
      if (::testing::Test::HasFailure()) return;
    }
  }
}

TEST(BvhTest, WithoutTrianglesThereIsNoAnswer) {
  const Bvh bvh(Mesh{{{1, 2, 3}}, {}});
  EXPECT_EQ(bvh.closest({0, 0, 0}).triangle, -1);
  EXPECT_TRUE(std::isinf(bvh.closest({0, 0, 0}).distance_squared));
  EXPECT_FALSE(bvh.contains({0, 0, 0}));
  EXPECT_FALSE(bvh.nearest_hit({{0, 0, 0}, {1, 0, 0}}));
  EXPECT_EQ(bvh.winding_number({0, 0, 0}), 0.0);
}

TEST(BvhTest, PointsThatAreNotFiniteHaveNoAnswer) {
  const Bvh bvh(make_sphere(1.0, 2));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(bvh.closest({nan, 0, 0}).triangle, -1);
  EXPECT_EQ(bvh.closest({0, std::numeric_limits<double>::infinity(), 0}).triangle, -1);
  EXPECT_FALSE(bvh.nearest_hit({{nan, 0, 0}, {1, 0, 0}}));
}

TEST(BvhTest, RejectsWhatIsNotAMesh) {
  EXPECT_THROW(Bvh(Mesh{{{0, 0, 0}}, {{0, 0, 1}}}), InputError);
  EXPECT_THROW(Bvh(Mesh{{{0, 0, 0}}, {{0, -1, 0}}}), InputError);
  EXPECT_THROW(Bvh(Mesh{{{0, 0, std::nan("")}}, {{0, 0, 0}}}), InputError);
  EXPECT_THROW(Bvh(Mesh{{{0, 1e200, 0}}, {{0, 0, 0}}}), InputError);
}

}  // namespace
}  // namespace haptrial::geometry
