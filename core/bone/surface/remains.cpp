#include "core/bone/surface/remains.h"

#include <algorithm>
#include <cmath>

namespace haptrial::bone {
namespace {

constexpr int kEdge = BoneVolume::kEdge;
constexpr int kBits = 4;

/// 1 to kWhole: of a voxel that holds bone.
int share_left(const BoneVolume& volume, std::int32_t address) {
  const float whole = volume.original(address);
  const float left = volume.density(address);
  return whole > left
             ? std::max(1, static_cast<int>(std::lround(RemainingFraction::kWhole * left / whole)))
             : RemainingFraction::kWhole;
}

/// The shares of eight voxels, packed as row() has them. @param holding  bit x: x holds bone
std::uint32_t row_of(const BoneVolume& volume, std::int32_t first, unsigned holding) {
  std::uint32_t row = 0;
  for (int x = 0; x < kEdge; ++x) {
    const bool holds = (holding >> x & 1U) != 0;
    const int share = holds ? share_left(volume, first + x) : RemainingFraction::kWhole;
    row |= static_cast<std::uint32_t>(share - 1) << (kBits * x);
  }
  return row;
}

}  // namespace

void RemainingFraction::follow(const BoneVolume& volume, const Occupancy& occupancy,
                               std::span<const std::int32_t> bricks, std::vector<Voxel>* changed) {
  bricks_.resize(static_cast<std::size_t>(volume.bricks()));
  for (const std::int32_t brick : bricks) {
    std::unique_ptr<Brick>& known = bricks_[static_cast<std::size_t>(brick)];
    for (std::size_t at = 0; at < kRows; ++at) {
      const int y = static_cast<int>(at) % kEdge;
      const int z = static_cast<int>(at) / kEdge;
      const auto holding = static_cast<unsigned>(occupancy.layer(brick, z) >> (kEdge * y) & 0xFFU);
      const std::int32_t first =
          brick * BoneVolume::kBrickVoxels + kEdge * static_cast<std::int32_t>(at);
      const std::uint32_t now = row_of(volume, first, holding);
      const std::uint32_t before = row(brick, y, z);
      if (now == before) {
        continue;
      }
      if (known == nullptr) {
        known = std::make_unique<Brick>();
        known->fill(kWholeRow);
      }
      (*known)[at] = now;
      for (int x = 0; x < kEdge && changed != nullptr; ++x) {
        const bool other = ((now ^ before) >> (kBits * x) & 0xFU) != 0;
        if (other && (holding >> x & 1U) != 0) {
          changed->push_back(volume.voxel_at(first + x));
        }
      }
    }
  }
}

}  // namespace haptrial::bone
