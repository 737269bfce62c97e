// Which structure is nearest, against a search through all voxels.

#include "core/bone/model/nearest_structure.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/base/random.h"

namespace haptrial::bone {
namespace {

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
      const std::uint8_t label = model.labels[model.grid.index(o.x(), o.y(), o.z())];
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
