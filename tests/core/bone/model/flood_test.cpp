#include "core/bone/model/flood.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/base/random.h"
#include "tests/core/bone/model/pieces_support.h"

namespace haptrial::bone {
namespace {

using test::for_each_voxel;

Flood look(const BoneVolume& volume) {
  Occupancy occupancy;
  std::vector<Voxel> changed;
  occupancy.follow(volume, changed);
  Flood flood;
  flood.look(volume, occupancy);
  return flood;
}

/// Parts as sorted lists of addresses, themselves sorted.
template <class Parts>
std::vector<std::vector<std::int32_t>> sorted(const BoneVolume& volume, const Parts& parts) {
  std::vector<std::vector<std::int32_t>> all;
  for (const auto& part : parts) {
    auto& addresses = all.emplace_back();
    for (const Voxel& voxel : part) {
      addresses.push_back(volume.address(voxel));
    }
    std::sort(addresses.begin(), addresses.end());
  }
  std::sort(all.begin(), all.end());
  return all;
}

TEST(FloodTest, FindsThePartsThatWalkingFinds) {
  RandomStream random(3, "floods");
  std::size_t parts_seen = 0;
  for (int trial = 0; trial < 60; ++trial) {
    // Around the share of 0.31 at which voxels begin to hang together parts are of every size.
    const double share = random.uniform(0.15, 0.6);
    const std::array<std::int32_t, 3> size{static_cast<std::int32_t>(1 + random.below(40)),
                                           static_cast<std::int32_t>(1 + random.below(40)),
                                           static_cast<std::int32_t>(1 + random.below(40))};
    const BoneModel model =
        test::make_bone(size, [&](const Voxel&) { return random.uniform() < share; });
    const BoneVolume volume(model);
    const auto walked =
        test::walk_parts(model.grid, [&](const Voxel& v) { return volume.density(v) > 0.0F; });
    const Flood flood = look(volume);
    EXPECT_EQ(flood.parts(), walked.size());
    EXPECT_EQ(sorted(volume, flood.all(volume)), sorted(volume, walked)) << "trial " << trial;
    parts_seen += walked.size();
  }
  EXPECT_GT(parts_seen, 10'000U);
}

TEST(FloodTest, APartIsInOrderOfAddressAndTheBiggestStays) {
  RandomStream random(4, "floods");
  const BoneVolume volume(
      test::make_bone({33, 31, 29}, [&](const Voxel&) { return random.uniform() < 0.33; }));
  const Flood flood = look(volume);
  const auto all = flood.all(volume);
  const auto loose = flood.loose(volume);
  ASSERT_EQ(all.size(), loose.size() + 1);
  EXPECT_EQ(all.front().size(), flood.biggest());
  std::int32_t before = 0;
  for (const Part& part : loose) {
    EXPECT_LE(part.size(), flood.biggest());
    EXPECT_GT(volume.address(part.front()), before);
    before = volume.address(part.front());
    EXPECT_TRUE(std::is_sorted(part.begin(), part.end(), [&](const Voxel& a, const Voxel& b) {
      return volume.address(a) < volume.address(b);
    }));
  }
  for (const Part& part : all) {
    EXPECT_EQ(flood.part_of(volume, part.back()), part);
  }
}

TEST(FloodTest, VoxelsThatOnlyMeetAtAnEdgeOrACornerAreApart) {
  for (const Voxel& step : {Voxel(1, 1, 0), Voxel(1, 0, -1), Voxel(0, -1, 1), Voxel(1, 1, 1)}) {
    for (const int corner : {3, 8}) {  // within a brick and across its sides
      const Voxel first = Voxel::Constant(corner);
      const BoneVolume volume(test::make_bone(
          {12, 12, 12}, [&](const Voxel& v) { return v == first || v == first - step; }));
      EXPECT_EQ(look(volume).parts(), 2U);
    }
  }
}

TEST(FloodTest, OfEqualPartsTheOneThatComesFirstStays) {
  const BoneVolume volume(test::make_bone({9, 4, 4}, [](const Voxel& v) { return v.x() != 4; }));
  const auto loose = look(volume).loose(volume);
  ASSERT_EQ(loose.size(), 1U);
  EXPECT_EQ(loose[0].size(), 64U);
  EXPECT_EQ(loose[0].front(), Voxel(5, 0, 0));
}

TEST(FloodTest, ACheckerboardIsAllCrumbs) {
  const BoneVolume volume(test::make_bone(
      {20, 20, 20}, [](const Voxel& v) { return (v.x() + v.y() + v.z()) % 2 == 0; }));
  EXPECT_EQ(look(volume).parts(), 4000U);
  EXPECT_EQ(look(volume).loose(volume).size(), 3999U);
}

TEST(FloodTest, NothingHasNoParts) {
  const BoneVolume volume(test::make_bone({9, 9, 9}, [](const Voxel&) { return false; }));
  EXPECT_EQ(look(volume).parts(), 0U);
  EXPECT_TRUE(look(volume).loose(volume).empty());
  EXPECT_TRUE(look(volume).all(volume).empty());
  EXPECT_TRUE(look(volume).part_of(volume, Voxel(1, 1, 1)).empty());
}

}  // namespace
}  // namespace haptrial::bone
