#include "core/bone/model/bone_volume.h"

#include <gtest/gtest.h>

#include <map>
#include <set>
#include <stdexcept>
#include <tuple>
#include <vector>

#include "core/base/random.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/solid_bone.h"

namespace haptrial::bone {
namespace {

using Key = std::tuple<int, int, int>;
Key key(const Voxel& v) { return {v.x(), v.y(), v.z()}; }

/// Sizes that are no multiples of a brick's, scattered bone of several labels and densities.
BoneModel scattered(std::uint64_t seed) {
  RandomStream random(seed, "scattered");
  BoneModel model;
  model.grid = {{21, 33, 18}, {0.1, -0.2, 0.3}, 0.5e-3};
  model.structures = {{}, {"bone"}, {"nerve"}};
  for (int k = 0; k < 18; ++k) {
    for (int j = 0; j < 33; ++j) {
      for (int i = 0; i < 21; ++i) {
        const bool bone = i / 7 != 1 && random.below(4) == 0;
        model.labels.push_back(bone ? static_cast<std::uint8_t>(1 + random.below(2)) : 0);
        model.density.push_back(bone ? static_cast<float>(1.0 - random.uniform()) : 0.0F);
      }
    }
  }
  return model;
}

Voxel random_voxel(RandomStream& random) {
  const auto at = [&](int size) { return static_cast<int>(random.below(size + 8)) - 4; };
  return {at(21), at(33), at(18)};
}

TEST(BoneVolumeTest, HoldsTheModelVoxelForVoxel) {
  const BoneModel model = scattered(1);
  const BoneVolume volume(model);
  double sum = 0.0;
  for (int k = -2; k < 20; ++k) {
    for (int j = -2; j < 35; ++j) {
      for (int i = -2; i < 23; ++i) {
        const bool in = i >= 0 && j >= 0 && k >= 0 && i < 21 && j < 33 && k < 18;
        const std::size_t at = in ? model.grid.index(i, j, k) : 0;
        EXPECT_EQ(volume.density(Voxel(i, j, k)), in ? model.density[at] : 0.0F);
        EXPECT_EQ(volume.label(Voxel(i, j, k)), in ? model.labels[at] : 0);
        sum += in ? static_cast<double>(model.density[at]) : 0.0;
      }
    }
  }
  EXPECT_NEAR(volume.amount(), sum, 1e-9 * sum);
}

TEST(BoneVolumeTest, AddressesAndVoxelsGoBackAndForth) {
  const BoneVolume volume(scattered(2));
  std::set<Key> seen;
  for (std::int32_t at = BoneVolume::kBrickVoxels; at < volume.bricks() * 512; ++at) {
    const Voxel voxel = volume.voxel_at(at);
    EXPECT_TRUE(seen.insert(key(voxel)).second);
    const auto& size = volume.grid().size;
    if (voxel.x() < size[0] && voxel.y() < size[1] && voxel.z() < size[2]) {
      EXPECT_EQ(volume.address(voxel), at);
    } else {
      EXPECT_EQ(volume.address(voxel), 0);  // a brick's part beyond the grid
    }
  }
}

TEST(BoneVolumeTest, TakesAndPutsLikeAMap) {
  const BoneModel model = scattered(3);
  BoneVolume volume(model);
  std::map<Key, float> map;
  for (std::int32_t at = BoneVolume::kBrickVoxels; at < volume.bricks() * 512; ++at) {
    if (volume.density(at) > 0.0F) {
      map[key(volume.voxel_at(at))] = volume.density(at);
    }
  }
  RandomStream random(3, "changes");
  for (int n = 0; n < 50000; ++n) {
    const Voxel voxel = random_voxel(random);
    const std::int32_t at = volume.address(voxel);
    const auto found = map.find(key(voxel));
    ASSERT_EQ(volume.density(at), found == map.end() ? 0.0F : found->second);
    if (at == 0) {
      continue;
    }
    const std::uint32_t version = volume.version(at / 512);
    const auto amount = static_cast<float>(random.uniform(0.0, 1.0));
    if (random.below(2) == 0) {
      volume.put(at, amount);
      map[key(voxel)] = amount;
    } else {
      float& held = map[key(voxel)];
      const float rest = amount < held ? held - amount : 0.0F;
      EXPECT_EQ(volume.take(at, amount), held - rest);
      held = rest;
    }
    EXPECT_NE(volume.version(at / 512), version);
  }
}

TEST(BoneVolumeTest, AddressZeroIsEmptyAndStaysSo) {
  const BoneVolume volume(scattered(4));
  for (std::int32_t at = 0; at < BoneVolume::kBrickVoxels; ++at) {
    EXPECT_EQ(volume.density(at), 0.0F);
    EXPECT_EQ(volume.label(at), 0);
  }
}

TEST(BoneVolumeTest, APartHasRoomAndLabelsButNoBone) {
  const BoneVolume whole(scattered(5));
  std::vector<Voxel> part;
  RandomStream random(5, "part");
  for (int n = 0; n < 300; ++n) {
    part.push_back(random_voxel(random));  // some outside, some without a brick
  }
  BoneVolume room(whole, part);
  EXPECT_EQ(room.amount(), 0.0);
  for (const Voxel& voxel : part) {
    const std::int32_t at = room.address(voxel);
    EXPECT_EQ(at != 0, whole.address(voxel) != 0);
    EXPECT_EQ(room.label(at), whole.label(voxel));
    if (at != 0) {
      room.put(at, 0.5F);
      EXPECT_EQ(room.density(voxel), 0.5F);
    }
  }
}

TEST(BoneVolumeTest, ChangingDoesNotAllocate) {
  BoneVolume volume(scattered(6));
  const test::AllocationGuard guard;
  for (std::int32_t at = BoneVolume::kBrickVoxels; at < volume.bricks() * 512; ++at) {
    volume.take(at, 0.25F);
    volume.put(at, 0.5F);
  }
  EXPECT_EQ(guard.count(), 0U);
}

TEST(BoneVolumeTest, AModelThatDoesNotFitTogetherIsRefused) {
  const auto refused = [](auto&& spoil) {
    BoneModel model = scattered(7);
    spoil(model);
    EXPECT_THROW(BoneVolume{model}, std::invalid_argument);
  };
  refused([](BoneModel& m) { m.labels.pop_back(); });
  refused([](BoneModel& m) { m.density.pop_back(); });
  refused([](BoneModel& m) { m.grid.spacing = 0.0; });
  refused([](BoneModel& m) { m.structures.resize(1); });
  refused([](BoneModel& m) { m.density[0] = 1.5F; });
  refused([](BoneModel& m) {
    m.labels[0] = 1;
    m.density[0] = 0.0F;
  });
}

}  // namespace
}  // namespace haptrial::bone
