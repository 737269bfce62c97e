#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "core/bone/model/bone_volume.h"
#include "core/bone/model/occupancy.h"
#include "core/bone/surface/surface_depths.h"

namespace haptrial::bone {

/// Which structure shows through at a voxel of a bone that is being removed: the nearest one of
/// which there is something left, just as StructureDepths of the bone as it is now would say. What
/// it said of the whole bone is a bound, so that a search ends where nothing near is gone.
/// One thread, that of the Occupancy it is given.
class NearStructures {
 public:
  /// @param depths  of the bone before anything was removed; null: nothing shows through
  explicit NearStructures(std::shared_ptr<const StructureDepths> depths);

  /// Notes where a volume may hold structures; call before the first at(). Always the same volume.
  /// @param occupancy  of the volume
  void begin(const BoneVolume& volume, const Occupancy& occupancy);
  /// Something that shows has gone: from now on at() looks whether the nearest is still there.
  void lose() noexcept { whole_ = false; }

  /// The nearest structure; none if nothing is left within reach.
  /// @param occupancy  of the volume
  NearStructure at(const BoneVolume& volume, const Occupancy& occupancy,
                   const Voxel& voxel) const noexcept;

  /// Whether a voxel's structure shows through.
  bool shows(const BoneVolume& volume, const Voxel& voxel) const noexcept;
  int reach() const noexcept;  // in whole voxels, rounded up

 private:
  struct NearestVoxel {
    int squared;  // distance in voxels
    std::uint8_t label;
  };
  void look_in(const BoneVolume& volume, const Occupancy& occupancy, std::int32_t brick,
               const Voxel& voxel, NearestVoxel& found) const noexcept;

  std::shared_ptr<const StructureDepths> depths_;
  bool whole_{false};                      // the volume has all structures that the depths know
  std::vector<std::uint64_t> structures_;  // voxels that show, by brick and layer of z
  struct NeighbourBrick {
    Voxel offset;  // in bricks
    int least;     // squared distance of voxels that lie so far apart
  };
  std::vector<NeighbourBrick> around_;  // nearest first
};

}  // namespace haptrial::bone
