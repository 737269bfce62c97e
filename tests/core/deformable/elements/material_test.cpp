#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <map>
#include <set>
#include <vector>

#include "core/deformable/elements/material.h"
#include "core/deformable/elements/volume_patches.h"
#include "tests/support/jittered_block.h"
#include "tests/support/message_of.h"

namespace haptrial::deformable {
namespace {

std::string refusal(const Material& material) {
  return test::message_of([&] { check_material(material, "material 0"); });
}

TEST(MaterialTest, ModuliAreThoseOfTheHandbook) {
  const Moduli steel = moduli({210e9, 0.3, 7850});
  EXPECT_NEAR(steel.shear, 80.769230769e9, 1);
  EXPECT_NEAR(steel.bulk, 175e9, 1e-3);
}

TEST(MaterialTest, WhatCannotBeIsRefused) {
  EXPECT_EQ(refusal({0, 0.3, 1000}), "material 0: Young's modulus is 0 Pa; allowed: above 0");
  EXPECT_EQ(refusal({-1, 0.3, 1000}), "material 0: Young's modulus is -1 Pa; allowed: above 0");
  EXPECT_EQ(refusal({1e4, 0.5, 1000}),
            "material 0: Poisson's ratio is 0.5; allowed: above -1 and below 0.5");
  EXPECT_EQ(refusal({1e4, -1, 1000}),
            "material 0: Poisson's ratio is -1; allowed: above -1 and below 0.5");
  EXPECT_EQ(refusal({1e4, std::numeric_limits<double>::quiet_NaN(), 1000}),
            "material 0: Poisson's ratio is nan; allowed: above -1 and below 0.5");
  EXPECT_EQ(refusal({1e4, 0.3, 0}), "material 0: the density is 0 kg/m³; allowed: above 0");
  EXPECT_EQ(refusal({1e4, 0.499, 980}), "nothing was thrown");
}

TEST(MaterialTest, LawsHaveNames) {
  EXPECT_EQ(name_of(Law::kLinear), "linear");
  EXPECT_EQ(name_of(Law::kCorotational), "corotational");
  EXPECT_EQ(name_of(Law::kNeoHookean), "neo-hookean");
}

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
