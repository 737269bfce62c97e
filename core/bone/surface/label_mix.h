#pragma once

#include <cstdint>
#include <vector>

#include "core/bone/surface/surface_cells.h"

namespace haptrial::bone {

/// The structure that borders on a vertex's own, for colours without the steps of the voxels.
class LabelMix {
 public:
  struct Other {
    std::uint8_t label{0};
    std::uint8_t share{0};  // of what is filled around the vertex; 255 is all
  };

  LabelMix() = default;
  /// @param volume  whose labels never change
  explicit LabelMix(const BoneVolume& volume);

  /// Whether voxels around the cells of a brick have more than one label; else there is no other.
  /// @param origin  of the cells, as CellField::read() has it
  bool is_mixed(const BoneVolume& volume, const Voxel& origin) const noexcept;
  /// The other label that fills most of the 4 x 4 x 4 voxels around a cell, weighted 1, 3, 3, 1
  /// along each axis. @param own  label of the vertex
  static Other around(const BoneVolume& volume, const CellField& field, const Voxel& origin,
                      const Voxel& of_brick, std::uint8_t own) noexcept;

 private:
  static constexpr std::uint8_t kMixed = 255;  // no label: a model has fewer
  std::vector<std::uint8_t> labels_;           // by brick: the only one, 0 or kMixed
};

}  // namespace haptrial::bone
