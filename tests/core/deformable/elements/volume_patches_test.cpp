#include "core/deformable/elements/volume_patches.h"

#include <gtest/gtest.h>

#include <map>
#include <set>

#include "tests/support/jittered_block.h"

namespace haptrial::deformable {
namespace {

TEST(VolumePatchesTest, AVoxelsFiveAreOne) {
  const auto mesh = test::solid_block({3, 2, 4}, 0.01);
  const auto patch = volume_patches(mesh.tetrahedra, {}, VolumeForm::kPatches);
  for (std::size_t t = 0; t < patch.size(); ++t) {
    EXPECT_EQ(patch[t], static_cast<std::int32_t>(t / 5));
  }
  const PatchLayout layout = patch_layout(mesh.tetrahedra, patch);
  EXPECT_EQ(layout.patches(), 24u);
  EXPECT_EQ(layout.vertices.size(), 24u * 8);
}

TEST(VolumePatchesTest, OthersGrowByNeighboursOfOneMaterial) {
  auto mesh = test::solid_block({6, 6, 6}, 0.01);
  test::shuffle_tetrahedra(mesh);
  std::vector<std::uint8_t> material;
  for (const auto& t : mesh.tetrahedra) {
    material.push_back(mesh.vertices[static_cast<std::size_t>(t[0])].x() > 0.03);
  }
  const auto patch = volume_patches(mesh.tetrahedra, material, VolumeForm::kPatches);
  std::map<std::int32_t, int> sizes;
  std::map<std::int32_t, std::set<int>> materials;
  for (std::size_t t = 0; t < patch.size(); ++t) {
    ++sizes[patch[t]];
    materials[patch[t]].insert(material[t]);
  }
  int small = 0;
  for (const auto& [number, size] : sizes) {
    EXPECT_EQ(materials[number].size(), 1u);
    small += size < 3;
  }
  EXPECT_LE(small, 2);
  // About as many patches as vertices: more would lock.
  EXPECT_LT(sizes.size(), mesh.vertices.size());
}

TEST(VolumePatchesTest, TetrahedraAloneArePatchesOfOne) {
  const auto mesh = test::solid_block({1, 1, 1}, 0.01);
  EXPECT_EQ(volume_patches(mesh.tetrahedra, {}, VolumeForm::kTetrahedra),
            (std::vector<std::int32_t>{0, 1, 2, 3, 4}));
}

}  // namespace
}  // namespace haptrial::deformable
