#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/bone/model/bone_model.h"
#include "core/geometry/mesh/work.h"

namespace haptrial::bone {

/// A structure that other ears gave to a bone.
struct CarriedStructure {
  std::uint8_t label{0};  // in the bone
  std::size_t voxels{0};
  /// 95 % of the true structure is expected within this distance of its label [m]; nothing if only
  /// one ear has the structure, or so few agree that ears without one of them lose it.
  std::optional<double> margin;
};

/// Gives a bone the labels on which several ears agree best. With φ_i the signed distance of a
/// voxel from a structure as ear i has it, negative inside and cut off at 1 mm (2 voxels if that is
/// more), the voxel belongs to the structure with the least mean φ over the ears that reach there,
/// if that is below 0. A mean keeps the shape of thin structures better than votes, and the cut
/// keeps an ear that is far off from outweighing the others. Voxels that the bone has as a
/// structure other than plain bone keep it; so does plain bone of at least half the full density
/// where the structure is one that a scan does not show as bone. Others take density 1.
///
/// For the margin each ear in turn is left out: it is the 95th percentile, over all ears, of how
/// far voxels of the ear's structure lie outside the structure that the other ears give.
///
/// Source: Rohlfing and Maurer 2007 (mean of distances); docs/algorithms/atlas.md.
/// @param ears     one field for each ear, of model.grid.count() labels, of model.structures or
///                 kBeyondEar
/// @param threads  0: one per processor; the result is the same
/// @returns the structures that some ear has, by label, plain bone left out
std::vector<CarriedStructure> fuse_labels(std::span<const std::vector<std::uint8_t>> ears,
                                          BoneModel& model, int threads = 0,
                                          const geometry::WorkReport& report = {});

}  // namespace haptrial::bone
