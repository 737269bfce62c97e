#include "core/bone/surface/near_structures.h"

#include <gtest/gtest.h>

#include <memory>

#include "core/base/random.h"
#include "tests/core/bone/surface/surface_checks.h"

namespace haptrial::bone::near_structures_test {
namespace {

constexpr int kSize = 34;
constexpr double kReach = 0.0094;
const std::vector<bool> kShows{false, false, true, true};

/// Bone with air in it and two kinds of structures, some of them in lumps.
BoneModel model_with_structures(RandomStream& random) {
  BoneModel model = model_of(kSize, [&](const Voxel& voxel) {
    const double lump = (voxel.cast<double>() - Eigen::Vector3d(9, 20, 14)).norm();
    const double chance = random.uniform();
    return lump < 4.0 ? 3 : chance < 0.004 ? 2 : chance < 0.006 ? 3 : chance < 0.2 ? 0 : 1;
  });
  model.structures.push_back({"sinus", {0.2, 0.3, 0.9}});
  return model;
}

/// The remaining bone, as a model of its own.
BoneModel left_of(const BoneModel& model, const BoneVolume& volume) {
  BoneModel left = model;
  for (std::size_t at = 0; at < left.labels.size(); ++at) {
    const auto i = static_cast<int>(at);
    const Voxel voxel(i % kSize, i / kSize % kSize, i / (kSize * kSize));
    left.labels[at] = volume.density(voxel) > 0.0F ? left.labels[at] : std::uint8_t{0};
  }
  return left;
}

void remove_ball(BoneVolume& volume, const Eigen::Vector3d& centre, double radius) {
  for (std::int32_t at = BoneVolume::kBrickVoxels; at < volume.bricks() * BoneVolume::kBrickVoxels;
       ++at) {
    if ((volume.voxel_at(at).cast<double>() - centre).norm() < radius) {
      volume.take(at, 1.0F);
    }
  }
}

TEST(NearStructuresTest, AreThoseThatDepthsOfWhatIsLeftSay) {
  RandomStream random(8, "near");
  const BoneModel model = model_with_structures(random);
  BoneVolume volume(model);
  NearStructures near(std::make_shared<const StructureDepths>(model, kShows, kReach));
  Occupancy occupancy;
  std::vector<Voxel> ignored;
  occupancy.follow(volume);
  near.begin(volume, occupancy);
  int gone = 0;
  int farther = 0;
  const StructureDepths before(model, kShows, kReach);
  for (int step = 0; step < 6; ++step) {
    occupancy.follow(volume, ignored);
    const StructureDepths now(left_of(model, volume), kShows, kReach);
    for (int k = 0; k < kSize; ++k) {
      for (int j = 0; j < kSize; ++j) {
        for (int i = 0; i < kSize; ++i) {
          if (!(volume.density(Voxel(i, j, k)) > 0.0F)) {
            continue;  // depths know nothing of bricks without bone
          }
          const NearStructure found = near.at(volume, occupancy, {i, j, k});
          ASSERT_EQ(found.label, now.at({i, j, k}).label) << i << " " << j << " " << k;
          ASSERT_EQ(found.distance, now.at({i, j, k}).distance);
          const NearStructure first = before.at({i, j, k});
          gone += first.label != 0 && found.label == 0 ? 1 : 0;
          farther += found.label != 0 && found.distance > first.distance ? 1 : 0;
        }
      }
    }
    const Eigen::Vector3d centre(random.uniform(4, 30), random.uniform(4, 30),
                                 random.uniform(4, 30));
    remove_ball(volume, step == 0 ? Eigen::Vector3d(9, 20, 14) : centre, 9.0);
    near.lose();
  }
  EXPECT_GT(gone, 100);
  EXPECT_GT(farther, 1000);
}

TEST(NearStructuresTest, WithoutDepthsNothingShows) {
  const BoneModel model = ball_model(12, 4.0);
  const BoneVolume volume(model);
  NearStructures near(nullptr);
  near.begin(volume, Occupancy());
  EXPECT_EQ(near.at(volume, Occupancy(), {6, 6, 6}).label, 0);
  EXPECT_FALSE(near.shows(volume, {6, 6, 6}));
}

}  // namespace
}  // namespace haptrial::bone::near_structures_test
