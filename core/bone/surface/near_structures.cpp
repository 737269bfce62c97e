#include "core/bone/surface/near_structures.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

namespace haptrial::bone {
namespace {

/// How far a number is outside of 0 .. 7.
int outside(int x) noexcept { return std::max({-x, x - (BoneVolume::kEdge - 1), 0}); }

}  // namespace

NearStructures::NearStructures(std::shared_ptr<const StructureDepths> depths)
    : depths_(std::move(depths)) {
  if (depths_ == nullptr) {
    return;
  }
  const int far = (reach() + BoneVolume::kEdge - 1) / BoneVolume::kEdge;
  const auto gap = [](int bricks) {
    const int voxels = std::max(0, BoneVolume::kEdge * (std::abs(bricks) - 1) + 1);
    return bricks == 0 ? 0 : voxels * voxels;
  };
  for (int k = -far; k <= far; ++k) {
    for (int j = -far; j <= far; ++j) {
      for (int i = -far; i <= far; ++i) {
        around_.push_back({{i, j, k}, gap(i) + gap(j) + gap(k)});
      }
    }
  }
  std::stable_sort(
      around_.begin(), around_.end(),
      [](const NeighbourBrick& a, const NeighbourBrick& b) { return a.least < b.least; });
}

int NearStructures::reach() const noexcept {
  return depths_ == nullptr ? 0 : static_cast<int>(std::ceil(depths_->reach_in_voxels()));
}

bool NearStructures::shows(const BoneVolume& volume, const Voxel& voxel) const noexcept {
  return depths_ != nullptr && depths_->shows(volume.label(voxel));
}

void NearStructures::begin(const BoneVolume& volume, const Occupancy& occupancy) {
  if (depths_ == nullptr) {
    return;
  }
  structures_.assign(static_cast<std::size_t>(volume.bricks()) * BoneVolume::kEdge, 0);
  for (std::int32_t at = BoneVolume::kBrickVoxels; at < volume.bricks() * BoneVolume::kBrickVoxels;
       ++at) {
    const auto bit = static_cast<std::uint64_t>(depths_->shows(volume.label(at)));
    structures_[static_cast<std::size_t>(at) / 64] |= bit << (at % 64);
  }
  std::size_t there = 0;
  for (std::size_t layer = 0; layer < structures_.size(); ++layer) {
    const auto brick = static_cast<std::int32_t>(layer / BoneVolume::kEdge);
    const std::uint64_t held = occupancy.layer(brick, static_cast<int>(layer % BoneVolume::kEdge));
    there += static_cast<std::size_t>(std::popcount(structures_[layer] & held));
  }
  whole_ = there == depths_->voxels();
}

NearStructure NearStructures::at(const BoneVolume& volume, const Occupancy& occupancy,
                                 const Voxel& voxel) const noexcept {
  const NearStructure before = depths_ == nullptr ? NearStructure{} : depths_->at(voxel);
  if (before.label == 0 || whole_) {
    return before;
  }
  const double spacing = volume.grid().spacing;
  const double voxels = before.distance / spacing;
  const NearestVoxel bound{static_cast<int>(std::lround(voxels * voxels)), before.label};
  const double farthest = depths_->reach_in_voxels() * depths_->reach_in_voxels();
  NearestVoxel found{static_cast<int>(farthest) + 1, 0};
  const Voxel home(voxel.x() / BoneVolume::kEdge, voxel.y() / BoneVolume::kEdge,
                   voxel.z() / BoneVolume::kEdge);
  for (const NeighbourBrick& around : around_) {
    if (around.least > found.squared) {
      break;
    }
    const std::int32_t address = volume.address(Voxel(BoneVolume::kEdge * (home + around.offset)));
    if (address != 0) {
      look_in(volume, occupancy, address / BoneVolume::kBrickVoxels, voxel, found);
      if (found.squared == bound.squared && found.label == bound.label) {
        break;  // nothing was ever nearer
      }
    }
  }
  if (found.label == 0) {
    return {};
  }
  return {found.label, spacing * std::sqrt(static_cast<double>(found.squared))};
}

void NearStructures::look_in(const BoneVolume& volume, const Occupancy& occupancy,
                             std::int32_t brick, const Voxel& voxel,
                             NearestVoxel& found) const noexcept {
  const Voxel from = voxel - volume.brick_origin(brick);
  const int aside = outside(from.x());
  const int nearest = aside * aside + outside(from.y()) * outside(from.y());
  for (int z = 0; z < BoneVolume::kEdge; ++z) {
    const int dz = (from.z() - z) * (from.z() - z);
    const std::uint64_t layer =
        occupancy.layer(brick, z) &
        structures_[static_cast<std::size_t>(brick * BoneVolume::kEdge + z)];
    if (layer == 0 || dz + nearest > found.squared) {
      continue;
    }
    for (int y = 0; y < BoneVolume::kEdge; ++y) {
      const auto row = static_cast<unsigned>(layer >> (BoneVolume::kEdge * y)) & 0xFFU;
      const int dyz = dz + (from.y() - y) * (from.y() - y);
      if (row == 0 || dyz + aside * aside > found.squared) {
        continue;
      }
      const unsigned upto =
          from.x() < 0 ? 0U : 0xFFU >> std::max(0, BoneVolume::kEdge - 1 - from.x());
      const auto consider = [&](int x) {
        const NearestVoxel here{dyz + (from.x() - x) * (from.x() - x),
                                volume.label(brick * BoneVolume::kBrickVoxels + x +
                                             BoneVolume::kEdge * (y + BoneVolume::kEdge * z))};
        const bool nearer = here.squared < found.squared;
        if (nearer || (here.squared == found.squared && here.label < found.label)) {
          found = here;
        }
      };
      if ((row & upto) != 0) {
        consider(std::bit_width(row & upto) - 1);
      }
      if ((row & ~upto) != 0) {
        consider(std::countr_zero(row & ~upto));
      }
    }
  }
}

}  // namespace haptrial::bone
