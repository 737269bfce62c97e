#include "core/deformable/touch/normal_forces.h"

#include <gtest/gtest.h>

#include "core/base/random.h"

namespace haptrial::deformable {
namespace {

/// The conditions themselves, for random matrices as near to singular as those of a surface.
TEST(NormalForcesTest, ForcesAndGapsAreNotNegativeAndNeverBoth) {
  RandomStream random(7, "places");
  for (int trial = 0; trial < 300; ++trial) {
    const int n = 1 + static_cast<int>(random.below(PressedPlaces::kMost));
    Eigen::MatrixXd root(n, n);
    for (int i = 0; i < n * n; ++i) {
      root(i) = random.normal();
    }
    PressedPlaces places;
    places.compliance =
        1e-3 * (root * root.transpose() / n + 1e-4 * Eigen::MatrixXd::Identity(n, n));
    places.free_gap.resize(n);
    PressedPlaces::Vector force(n);
    for (int i = 0; i < n; ++i) {
      places.free_gap[i] = 1e-3 * random.normal();
      force[i] = random.uniform() < 0.5 ? 1.0 : 0.0;
    }
    ASSERT_TRUE(press(places, force)) << trial;
    const PressedPlaces::Vector gap = places.free_gap + places.compliance * force;
    EXPECT_GE(force.minCoeff(), 0.0);
    EXPECT_GE(gap.minCoeff(), -1e-9);
    EXPECT_LT(force.cwiseProduct(gap).cwiseAbs().maxCoeff(), 1e-8);
  }
}

}  // namespace
}  // namespace haptrial::deformable
