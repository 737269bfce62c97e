#include "core/geometry/bvh/bvh.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <sstream>
#include <string>

#include "core/base/error.h"
#include "core/geometry/mesh/triangle_distance.h"
#include "tests/core/geometry/mesh/mesh_cases.h"
#include "tests/support/allocation_guard.h"

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

bool same(const ClosestPoint& a, const ClosestPoint& b) {
  return a.distance_squared == b.distance_squared && a.triangle == b.triangle && a.part == b.part &&
         a.point == b.point;
}

std::string text(const ClosestPoint& a) {
  std::ostringstream out;
  out.precision(17);
  out << a.distance_squared << " to " << a.point.transpose() << " on triangle " << a.triangle
      << ", part " << static_cast<int>(a.part);
  return out.str();
}

#define ASSERT_SAME(found, expected, point) \
  ASSERT_TRUE(same(found, expected))        \
      << "of " << (point).transpose() << ": " << text(found) << " instead of " << text(expected)

constexpr int kPoints = 800;  // of each case

TEST(BvhTest, FindsWhatBruteForceFinds) {
  for (const MeshCase& mesh_case : mesh_cases()) {
    SCOPED_TRACE(mesh_case.name);
    const Bvh bvh(mesh_case.mesh);
    for (const Eigen::Vector3d& point : hard_points(mesh_case.mesh, kPoints, 1)) {
      ASSERT_SAME(bvh.closest(point), brute_force(mesh_case.mesh, point), point);
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
      ASSERT_SAME(bvh.closest(point, hint), bvh.closest(point), point);
    }
  }
}

TEST(BvhTest, ManyPointsGetTheAnswersOfEachOnEveryInstructionSet) {
  for (const MeshCase& mesh_case : mesh_cases()) {
    SCOPED_TRACE(mesh_case.name);
    const Bvh bvh(mesh_case.mesh);
    std::vector<Eigen::Vector3d> points = hard_points(mesh_case.mesh, 3 * kPoints + 5, 3);
    points[7].y() = std::numeric_limits<double>::quiet_NaN();
    for (const InstructionSet set : available_instruction_sets()) {
      SCOPED_TRACE(name_of(set));
      const Bvh with_set(mesh_case.mesh, {.threads = 2, .instruction_set = set});
      std::vector<ClosestPoint> answers(points.size());
      with_set.closest(points, answers);
      for (std::size_t i = 0; i < points.size(); ++i) {
        ASSERT_SAME(answers[i], bvh.closest(points[i]), points[i]);
        ASSERT_SAME(with_set.closest(points[i]), answers[i], points[i]);
      }
    }
  }
}

TEST(BvhTest, OneNearestPointDoesNotAllocate) {
  const Bvh bvh(make_gear());
  const auto points = hard_points(make_gear(), 64, 4);
  double sum = 0.0;
  std::size_t allocations = 0;
  {
    const test::AllocationGuard guard;
    for (const Eigen::Vector3d& point : points) {
      sum += bvh.closest(point).distance_squared;
    }
    allocations = guard.count();
  }
  EXPECT_EQ(allocations, 0u);
  EXPECT_GT(sum, 0.0);
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
