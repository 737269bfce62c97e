#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/bone/model/bone_model.h"
#include "core/bone/model/bone_volume.h"

namespace haptrial::bone {

/// In a field of labels: beyond the ear that gave them, where nobody knows what is there.
inline constexpr std::uint8_t kBeyondEar = 255;

/// A structure as several fields of labels have it, in the part of their grid that holds all of it
/// and one voxel around.
struct StructureMasks {
  static constexpr std::uint8_t kIn = 1;
  static constexpr std::uint8_t kOut = 2;
  static constexpr std::uint8_t kUnknown = 3;  // beyond the ear

  Voxel low{Voxel::Zero()};       // of the part, in the grid
  geometry::VoxelGrid grid;       // of the part; without voxels where no field has the structure
  std::vector<BoneModel> fields;  // one for each, with these labels alone
};

/// @param fields  each of grid.count() labels
StructureMasks masks_of(const geometry::VoxelGrid& grid,
                        std::span<const std::span<const std::uint8_t>> fields, std::uint8_t label);

/// A mask of the same part with other voxels in it.
BoneModel mask_like(const StructureMasks& masks, const std::vector<bool>& in);

/// Distance between centres from each voxel of the part to the nearest one with the label [m];
/// infinite beyond 20 mm or 250 voxels, and where there is none.
std::vector<float> distances_to(const BoneModel& mask, std::uint8_t label);

}  // namespace haptrial::bone
