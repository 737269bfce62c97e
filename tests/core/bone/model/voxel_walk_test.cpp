#include "core/bone/model/voxel_walk.h"

#include <gtest/gtest.h>

#include <map>
#include <vector>

#include "core/base/random.h"

namespace haptrial::bone {
namespace {

struct Visit {
  Voxel voxel;
  double in;
  double out;
};

std::vector<Visit> visits(const geometry::VoxelGrid& grid, const Eigen::Vector3d& from,
                          const Eigen::Vector3d& to) {
  std::vector<Visit> all;
  walk_voxels(grid, from, to, [&](const Voxel& voxel, double in, double out) {
    all.push_back({voxel, in, out});
    return true;
  });
  return all;
}

const geometry::VoxelGrid kGrid{{9, 7, 11}, {0.1, -0.2, 0.3}, 0.05};

TEST(VoxelWalkTest, AStraightRowIsVisitedVoxelByVoxel) {
  const auto all = visits(kGrid, kGrid.centre(-2, 3, 4), kGrid.centre(12, 3, 4));
  ASSERT_EQ(all.size(), 9U);
  for (int i = 0; i < 9; ++i) {
    EXPECT_EQ(all[static_cast<std::size_t>(i)].voxel, Voxel(i, 3, 4));
  }
}

TEST(VoxelWalkTest, FindsTheVoxelsThatDenseSamplingFinds) {
  RandomStream random(7, "walks");
  const auto point = [&] {
    return Eigen::Vector3d(random.uniform(-0.2, 0.8), random.uniform(-0.5, 0.4),
                           random.uniform(0.0, 1.1));
  };
  int crossed = 0;
  for (int trial = 0; trial < 500; ++trial) {
    const Eigen::Vector3d from = point();
    const Eigen::Vector3d to = point();
    const auto all = visits(kGrid, from, to);
    std::size_t place = 0;
    for (int s = 0; s <= 4000; ++s) {
      const double t = s / 4000.0;
      const Eigen::Array3d at =
          ((from + t * (to - from) - kGrid.origin) / kGrid.spacing).array() + 0.5;
      const Voxel voxel = at.floor().cast<int>();
      bool inside = true;
      for (int axis = 0; axis < 3; ++axis) {
        inside =
            inside && voxel[axis] >= 0 && voxel[axis] < kGrid.size[static_cast<std::size_t>(axis)];
      }
      if (!inside) {
        continue;
      }
      while (place < all.size() && all[place].out < t - 1e-12) {
        ++place;
      }
      ASSERT_LT(place, all.size());
      EXPECT_TRUE(all[place].voxel == voxel || std::abs(all[place].out - t) < 1e-9)
          << "trial " << trial << " at " << t;
      ++crossed;
    }
    for (std::size_t i = 1; i < all.size(); ++i) {
      EXPECT_EQ((all[i].voxel - all[i - 1].voxel).cwiseAbs().sum(), 1);
      EXPECT_DOUBLE_EQ(all[i].in, all[i - 1].out);
    }
  }
  EXPECT_GT(crossed, 100'000);
}

TEST(VoxelWalkTest, BesideTheGridAndWithoutNumbersNothingIsVisited) {
  EXPECT_TRUE(visits(kGrid, kGrid.centre(-2, -3, 0), kGrid.centre(-2, 30, 9)).empty());
  const double nan = std::nan("");
  EXPECT_TRUE(visits(kGrid, {nan, 0, 0}, kGrid.centre(1, 1, 1)).empty());
  EXPECT_TRUE(visits(kGrid, kGrid.centre(1, 1, 1), {0, nan, 0}).empty());
}

TEST(VoxelWalkTest, ASegmentWithoutLengthIsInOneVoxel) {
  const auto all = visits(kGrid, kGrid.centre(2, 2, 2), kGrid.centre(2, 2, 2));
  ASSERT_EQ(all.size(), 1U);
  EXPECT_EQ(all[0].voxel, Voxel(2, 2, 2));
}

}  // namespace
}  // namespace haptrial::bone
