#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <variant>

#include "core/geometry/volume/voxel_grid.h"

namespace haptrial::geometry {

/// A number per voxel, or several: a vector field has its components side by side.
struct Volume {
  VoxelGrid grid;
  /// grid.count() x components, voxel by voxel
  std::variant<std::span<const std::uint8_t>, std::span<const float>, std::span<const double>,
               std::span<const std::int32_t>>
      values;
  int components{1};
  std::string what;  // what a value is, with its unit
};

/// Writes a volume whole or not at all, in the format of the name's ending:
///
///     .nrrd  for ParaView, 3D Slicer and others: raw bytes behind a text head, places in [m]
///     .h5    HDF5: /volume (z x y x x), with attributes origin and spacing [m] and what
///
/// @throws InputError for another ending, or where the file is there or cannot be made; RunError
/// when writing fails.
void write_volume(const std::filesystem::path& file, const Volume& volume, bool overwrite = false);

/// The labels as 0 outside, 1 inside, 2 border.
Volume volume_of(const VoxelSolid& solid);

/// @throws InputError where write_volume() would not know the ending.
void check_volume_ending(const std::filesystem::path& file);

}  // namespace haptrial::geometry
