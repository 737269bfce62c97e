#pragma once

#include <cstddef>

#include "core/bone/model/bone_model.h"

namespace haptrial::bone {

/// Changes by one step of tidying.
struct TidyResult {
  std::size_t parts{0};   // that went, or holes that were filled
  std::size_t voxels{0};  // of them
};

/// Leaves of plain bone only what hangs together, through faces, with the part of the whole bone
/// that has most voxels: noise of a scan and what lies beside the head go. Other structures stay,
/// as an ossicle touches nothing.
TidyResult keep_largest_part(BoneModel& model);

/// Fills holes: empty voxels that faces do not connect with the grid's border, in parts of at most
/// `most_voxels`. A filled voxel takes the commonest label around its hole and, where the bone has
/// densities, the lowest density of bone.
TidyResult fill_holes(BoneModel& model, std::size_t most_voxels);

}  // namespace haptrial::bone
