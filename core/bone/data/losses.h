#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "core/bone/data/volume_source.h"
#include "core/bone/model/bone_model.h"

namespace haptrial::bone {

using LabelVolumes = std::array<double, 256>;  // of each label [m3]

/// Volumes of the labels of a bone.
LabelVolumes volumes_of(const BoneModel& model);
/// Volumes of the labels of a file, of which only voxels count whose centres lie in a box.
/// @param labels  whole numbers from 0 to 255, one for each voxel of the head
/// @param X_PB    from B, in which the box lies, to LPS
LabelVolumes volumes_of(std::span<const float> labels, const VolumeHead& head,
                        const std::optional<Eigen::AlignedBox3d>& box, const Eigen::Affine3d& X_PB);

/// Adds a note to a bone if it holds less than 80 % of what a file has of a structure: with coarser
/// voxels or at the border of the scan. The sentence has both volumes.
/// @param before, after  in the file and in the bone [m3]
void note_loss(const std::string& file, const Structure& structure, double before, double after,
               BoneModel& model);
/// Adds such a note for each label of a bone that lost as much.
void note_losses(const std::string& file, const LabelVolumes& before, BoneModel& model);

}  // namespace haptrial::bone
