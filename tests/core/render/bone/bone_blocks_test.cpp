#include "core/render/bone/bone_blocks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <map>
#include <vector>

#include "tests/core/render/bone/bone_changes.h"

namespace haptrial::render {
namespace {

using bone::BoneVolume;
using bone::Surface;
using bone::SurfaceTriangle;
using bone::SurfaceVertex;
using bone::Voxel;

using Corners = std::array<SurfaceVertex, 3>;

/// Some order of all that a triangle shows.
bool comes_first(const Corners& a, const Corners& b) {
  const auto key = [](const Corners& corners) {
    std::array<float, 30> numbers{};
    auto to = numbers.begin();
    for (const SurfaceVertex& v : corners) {
      to = std::copy(v.place.begin(), v.place.end(), to);
      to = std::copy(v.normal.begin(), v.normal.end(), to);
      for (const std::uint8_t number : {v.label, v.density, v.near_label, v.near_depth}) {
        *to++ = number;
      }
    }
    return numbers;
  };
  return key(a) < key(b);
}

std::vector<Corners> corners_of(const Surface& surface) {
  std::vector<Corners> all;
  for (const SurfaceTriangle& t : bone::living(surface.triangles())) {
    all.push_back({surface.vertices()[t[0]], surface.vertices()[t[1]], surface.vertices()[t[2]]});
  }
  std::sort(all.begin(), all.end(), comes_first);
  return all;
}

bool holds(const Eigen::AlignedBox3d& box, const Corners& corners) {
  return std::all_of(corners.begin(), corners.end(), [&](const SurfaceVertex& vertex) {
    return box.exteriorDistance(bone::place_of(vertex)) < 1e-8;
  });
}

TEST(BoneBlocksTest, OutsideOfTheChangedBoxNothingChanges) {
  RandomStream random(5, "blocks");
  BoneVolume volume(bumpy(40));
  Surface surface;
  BoneBlocks blocks;
  std::vector<Corners> before;
  int small = 0;
  std::size_t seen_changes = 0;
  for (int step = 0; step < 60; ++step) {
    surface.update(volume);
    blocks.follow(surface, volume.grid());
    const std::vector<Corners> after = corners_of(surface);
    std::vector<Corners> changed;
    std::set_symmetric_difference(before.begin(), before.end(), after.begin(), after.end(),
                                  std::back_inserter(changed), comes_first);
    ASSERT_TRUE(std::all_of(changed.begin(), changed.end(), [&](const Corners& corners) {
      return holds(blocks.changed(), corners);
    })) << step;
    seen_changes += changed.size();
    small += blocks.changed().isEmpty() || blocks.changed().sizes().maxCoeff() < 0.025;
    before = after;
    change_at_random(volume, random);
  }
  EXPECT_GT(small, 50);
  EXPECT_GT(seen_changes, 5000U);
  surface.update(volume);
  blocks.follow(surface, volume.grid());
  surface.update(volume);
  blocks.follow(surface, volume.grid());
  EXPECT_TRUE(blocks.changed().isEmpty());
}

TEST(BoneBlocksTest, WhatVanishesWithoutATraceIsInTheChangedBox) {
  BoneVolume volume(bone::model_of(40, [](const Voxel& v) {
    return (v - Voxel(12, 12, 12)).squaredNorm() < 60 || (v - Voxel(33, 30, 31)).squaredNorm() < 9;
  }));
  Surface surface;
  BoneBlocks blocks;
  surface.update(volume);
  blocks.follow(surface, volume.grid());
  const std::vector<Corners> before = corners_of(surface);
  change(volume, Voxel(33, 30, 31), 4, 1.0F);
  surface.update(volume);
  blocks.follow(surface, volume.grid());
  const std::vector<Corners> after = corners_of(surface);
  std::vector<Corners> gone;
  std::set_difference(before.begin(), before.end(), after.begin(), after.end(),
                      std::back_inserter(gone), comes_first);
  EXPECT_GT(gone.size(), 100U);
  EXPECT_EQ(before.size() - after.size(), gone.size());
  EXPECT_TRUE(std::all_of(gone.begin(), gone.end(), [&](const Corners& corners) {
    return holds(blocks.changed(), corners);
  }));
}

TEST(BoneBlocksTest, EveryQuadIsInOneBlockThatHoldsIt) {
  RandomStream random(6, "blocks");
  BoneVolume volume(bumpy(37));
  Surface surface;
  BoneBlocks blocks;
  for (int step = 0; step < 80; ++step) {
    if (step == 60) {  // nearly all goes, and the surface packs its slots
      change(volume, Voxel(18, 18, 15), 16, 1.0F);
    }
    surface.update(volume);
    blocks.follow(surface, volume.grid());
    std::map<std::int32_t, int> seen;
    for (const BoneBlocks::Block& block : blocks.blocks()) {
      for (const std::int32_t quad : block.quads) {
        ++seen[quad];
        for (const std::size_t half : {0U, 1U}) {
          const SurfaceTriangle& t = surface.triangles()[2 * static_cast<std::size_t>(quad) + half];
          ASSERT_TRUE(holds(block.box, {surface.vertices()[t[0]], surface.vertices()[t[1]],
                                        surface.vertices()[t[2]]}));
          ASSERT_NE(t[0], t[1]) << "a dead quad";
        }
      }
    }
    ASSERT_EQ(2 * seen.size(), surface.triangle_count()) << step;
    for (const auto& [quad, times] : seen) {
      ASSERT_EQ(times, 1) << quad;
    }
    change_at_random(volume, random);
  }
}

}  // namespace
}  // namespace haptrial::render
