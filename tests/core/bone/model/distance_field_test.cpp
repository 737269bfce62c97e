#include "core/bone/model/distance_field.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/random.h"

namespace haptrial::bone {
namespace {

BoneModel empty_grid(int x, int y, int z, double spacing) {
  BoneModel model;
  model.grid = {{x, y, z}, Eigen::Vector3d(0.01, -0.02, 0.03), spacing};
  model.structures = {{}, {"bone"}, {"nerve"}, {"vein"}};
  model.labels.assign(model.grid.count(), 0);
  return model;
}

/// The least squared distance in voxels to a voxel of the set; -1 where there is none.
int nearest_squared(const BoneModel& model, const std::vector<bool>& labels, const Voxel& from) {
  int best = -1;
  for (int k = 0; k < model.grid.size[2]; ++k) {
    for (int j = 0; j < model.grid.size[1]; ++j) {
      for (int i = 0; i < model.grid.size[0]; ++i) {
        const std::uint8_t label = model.labels[model.grid.index(i, j, k)];
        const int squared = (Voxel(i, j, k) - from).squaredNorm();
        if (label != 0 && label < labels.size() && labels[label] && (best < 0 || squared < best)) {
          best = squared;
        }
      }
    }
  }
  return best;
}

TEST(DistanceFieldTest, EqualsBruteForce) {
  RandomStream random(1, "distance field");
  for (int n = 0; n < 60; ++n) {
    const auto side = [&] { return 1 + static_cast<int>(random.below(13)); };
    BoneModel model = empty_grid(side(), side(), side(), random.uniform(1e-4, 1e-3));
    const double share = n % 3 == 0 ? 0.003 : n % 3 == 1 ? 0.03 : 0.3;
    for (std::uint8_t& label : model.labels) {
      label = random.uniform() < share ? static_cast<std::uint8_t>(1 + random.below(3)) : 0;
    }
    const std::vector<bool> labels{true, false, true};  // 3 is beyond the list, 0 never counts
    const double reach = model.grid.spacing * random.uniform(0.0, 20.0);
    const DistanceField field(model, labels, reach);
    for (int k = 0; k < model.grid.size[2]; ++k) {
      for (int j = 0; j < model.grid.size[1]; ++j) {
        for (int i = 0; i < model.grid.size[0]; ++i) {
          const int squared = nearest_squared(model, labels, {i, j, k});
          const double distance = model.grid.spacing * std::sqrt(static_cast<double>(squared));
          const std::optional<double> found = field.at({i, j, k});
          ASSERT_EQ(found.has_value(), squared >= 0 && distance <= reach) << n;
          if (found) {
            ASSERT_EQ(*found, distance) << n;
          }
        }
      }
    }
  }
}

TEST(DistanceFieldTest, ReachesFar) {
  BoneModel model = empty_grid(260, 3, 200, 1e-3);
  model.labels[model.grid.index(0, 1, 0)] = 2;
  const DistanceField field(model, {false, false, true}, 0.25);
  EXPECT_DOUBLE_EQ(*field.at({250, 1, 0}), 0.25);
  EXPECT_FALSE(field.at({251, 1, 0}));
  EXPECT_DOUBLE_EQ(*field.at({150, 1, 199}), 1e-3 * std::hypot(150.0, 199.0));
  EXPECT_FALSE(field.at({250, 2, 0})) << "a hair beyond";
}

TEST(DistanceFieldTest, HasNothingWhereThereIsNothing) {
  BoneModel model = empty_grid(4, 4, 4, 1e-3);
  EXPECT_TRUE(DistanceField(model, {false, true}, 0.01).empty());
  EXPECT_FALSE(DistanceField(model, {false, true}, 0.01).at({1, 1, 1}));
  model.labels[0] = 1;
  const DistanceField field(model, {false, true}, 0.01);
  EXPECT_FALSE(field.empty());
  EXPECT_FALSE(field.at({-1, 0, 0}));
  EXPECT_FALSE(field.at({0, 4, 0}));
  EXPECT_EQ(*field.at({0, 0, 0}), 0.0);
}

TEST(DistanceFieldTest, RefusesWhatItCannotKeep) {
  const BoneModel model = empty_grid(4, 4, 4, 1e-3);
  EXPECT_THROW(DistanceField(model, {}, -1e-3), std::invalid_argument);
  EXPECT_THROW(DistanceField(model, {}, 0.2501), std::invalid_argument);
  EXPECT_THROW(DistanceField(model, {}, std::nan("")), std::invalid_argument);
}

}  // namespace
}  // namespace haptrial::bone
