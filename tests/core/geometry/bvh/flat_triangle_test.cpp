#include "core/geometry/bvh/flat_triangle.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/geometry/bvh/bvh.h"
#include "core/geometry/bvh/bvh_kernel.h"
#include "core/geometry/mesh/triangle_distance.h"
#include "tests/core/geometry/mesh/mesh_cases.h"

namespace haptrial::geometry {
namespace {

/// One float in the place of a vector.
struct OneFloat {
  using Number = float;
  static float all(float x) { return x; }
  static float fma(float a, float b, float c) { return a * b + c; }
  static float absolute(float x) { return std::abs(x); }
  static float smaller(float a, float b) { return std::min(a, b); }
  static float larger(float a, float b) { return std::max(a, b); }
  static bool less(float a, float b) { return a < b; }
  static float select(bool mask, float yes, float no) { return mask ? yes : no; }
};

double flat_distance(const Leaf& leaf, int place, const Eigen::Vector3f& p) {
  return std::sqrt(double{flat_distance_squared<OneFloat>(
      leaf, [place](const float* values) { return values[place]; }, p.x(), p.y(), p.z())});
}

// The search drops a triangle by its distance in single precision and this bound.
TEST(FlatTriangleTest, DistancesErrByLessThanTheSearchCountsOn) {
  double worst = 0.0;
  for (const auto& [name, mesh] : mesh_cases()) {
    SCOPED_TRACE(name);
    for (const InstructionSet set : available_instruction_sets()) {
      const Bvh bvh(mesh, {.instruction_set = set});
      const BvhData& data = bvh.data();
      RandomStream random(51, "slots");
      for (const Eigen::Vector3d& point : hard_points(mesh, 1500, 52)) {
        const Eigen::Vector3d in_frame = data.frame.to_frame(point);
        if (!kernel::is_near(in_frame)) {
          continue;
        }
        const std::int32_t slot = data.slots[random.below(mesh.triangles.size())];
        const Corners& c = data.corners[slot];
        const double exact =
            data.frame.scale *
            std::sqrt(closest_on_triangle(point, c[0], c[1], c[2]).distance_squared);
        const double found =
            flat_distance(data.leaves[slot / kWidth], slot % kWidth, in_frame.cast<float>());
        const auto reach = static_cast<float>(in_frame.cwiseAbs().maxCoeff());
        const double share = std::abs(found - exact) / double{search_error(reach)};
        ASSERT_LT(share, 1.0) << point.transpose();
        worst = std::max(worst, share);
      }
    }
  }
  EXPECT_GT(worst, 0.001) << "the bound says nothing";
  RecordProperty("worst_share_of_the_bound", std::to_string(worst));
}

TEST(FlatTriangleTest, AnEmptyPlaceIsInfinitelyFar) {
  Leaf leaf;
  leave_empty(leaf, 3);
  EXPECT_TRUE(std::isinf(flat_distance(leaf, 3, {0.0f, 0.5f, -16.0f})));
}

}  // namespace
}  // namespace haptrial::geometry
