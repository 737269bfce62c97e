#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <string>

#include "core/base/random.h"
#include "core/bone/model/distance_field.h"

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
  geometry::visit_voxels(model.grid, [&](const Voxel& voxel, std::size_t at) {
    const std::uint8_t label = model.labels[at];
    const int squared = (voxel - from).squaredNorm();
    if (label != 0 && label < labels.size() && labels[label] && (best < 0 || squared < best)) {
      best = squared;
    }
  });
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
    geometry::visit_voxels(model.grid, [&](const Voxel& voxel, std::size_t) {
      const int squared = nearest_squared(model, labels, voxel);
      const double distance = model.grid.spacing * std::sqrt(static_cast<double>(squared));
      const std::optional<double> found = field.at(voxel);
      ASSERT_EQ(found.has_value(), squared >= 0 && distance <= reach) << n;
      if (found) {
        ASSERT_EQ(*found, distance) << n;
      }
    });
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

// Which structure is nearest, against a search through all voxels.

/// Two vital structures, of one of which two labels are parts, and one that is not vital.
BoneModel scattered_structures() {
  BoneModel model;
  model.grid = {{12, 10, 8}, Eigen::Vector3d::Zero(), 0.5e-3};
  model.structures = {{}, {"bone"}, {"nerve"}, {"incus"}, {"nerve"}, {"dura"}, {"absent"}};
  for (const int vital : {2, 4, 5, 6}) {
    model.structures[static_cast<std::size_t>(vital)].vital = true;
  }
  RandomStream random(3, "scattered");
  for (std::size_t i = 0; i < model.grid.count(); ++i) {
    const double at = random.uniform();
    model.labels.push_back(static_cast<std::uint8_t>(at < 0.02   ? 2
                                                     : at < 0.03 ? 4
                                                     : at < 0.05 ? 5
                                                     : at < 0.07 ? 3
                                                                 : 1));
  }
  return model;
}

TEST(NearestStructureTest, NamesVitalStructuresThatAreThereOnce) {
  EXPECT_THAT(vital_structures(scattered_structures()), testing::ElementsAre("nerve", "dura"));
  EXPECT_THAT(labels_named(scattered_structures(), "nerve"),
              testing::ElementsAre(false, false, true, false, true, false, false));
}

TEST(NearestStructureTest, IsThatOfASearchThroughAllVoxels) {
  const BoneModel model = scattered_structures();
  constexpr double kReach = 1.4e-3;
  std::vector<std::shared_ptr<const DistanceField>> fields;
  for (const std::string& name : vital_structures(model)) {
    fields.push_back(
        std::make_shared<const DistanceField>(model, labels_named(model, name), kReach));
  }
  const auto& size = model.grid.size;
  int none = 0, dura = 0;
  const auto each = [&size](auto&& f) {
    for (int k = 0; k < size[2]; ++k) {
      for (int j = 0; j < size[1]; ++j) {
        for (int i = 0; i < size[0]; ++i) {
          f(Voxel(i, j, k));
        }
      }
    }
  };
  each([&](const Voxel& v) {
    std::array<int, 2> least{1 << 20, 1 << 20};  // squared
    each([&](const Voxel& o) {
      const std::uint8_t label = model.labels[model.grid.index(o)];
      const std::size_t which = label == 5 ? 1 : 0;
      if (label == 2 || label == 4 || label == 5) {
        least[which] = std::min(least[which], (o - v).squaredNorm());
      }
    });
    const int nearest = std::min(least[0], least[1]);
    const NearestStructure found = nearest_structure(fields, v);
    if (0.5e-3 * std::sqrt(nearest) > kReach) {
      EXPECT_EQ(found.structure, -1);
      ++none;
    } else {
      EXPECT_EQ(found.structure, least[1] < least[0] ? 1 : 0) << "the first of equally near ones";
      EXPECT_FLOAT_EQ(found.distance, static_cast<float>(0.5e-3 * std::sqrt(nearest)));
      dura += found.structure == 1 ? 1 : 0;
    }
  });
  EXPECT_GT(none, 10);
  EXPECT_GT(dura, 100);
}

}  // namespace
}  // namespace haptrial::bone
