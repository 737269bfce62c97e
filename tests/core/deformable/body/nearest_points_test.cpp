#include "core/deformable/body/skin.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/base/random.h"

namespace haptrial::deformable {
namespace {

using Eigen::Vector3d;

// Points on a coarse grid, so that many are equally near.
TEST(NearestPointsTest, AreThoseOfBruteForce) {
  RandomStream random(11, "near");
  for (const std::size_t count : {1u, 2u, 7u, 300u}) {
    std::vector<Vector3d> points;
    for (std::size_t i = 0; i < count; ++i) {
      points.push_back(Vector3d(static_cast<double>(random.below(6)),
                                static_cast<double>(random.below(6)),
                                static_cast<double>(random.below(6))));
    }
    const NearestPoints tree(points);
    std::vector<NearPoint> found;
    for (int query = 0; query < 200; ++query) {
      const Vector3d place(random.uniform(-1, 7), static_cast<double>(random.below(6)), 2.5);
      std::vector<NearPoint> expected;
      for (std::size_t i = 0; i < count; ++i) {
        expected.push_back({(place - points[i]).squaredNorm(), static_cast<std::int32_t>(i)});
      }
      std::sort(expected.begin(), expected.end());
      expected.resize(std::min<std::size_t>(count, 5));
      tree.find(place, 5, found);
      EXPECT_EQ(found, expected);
    }
  }
}

}  // namespace
}  // namespace haptrial::deformable
