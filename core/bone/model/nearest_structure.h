#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/bone/model/bone_model.h"
#include "core/bone/model/distance_field.h"

namespace haptrial::bone {

/// The vital structures of a bone by name, each once, that have voxels; in the order of labels.
std::vector<std::string> vital_structures(const BoneModel& bone);

/// Whether each label stands for a structure of this name.
std::vector<bool> labels_named(const BoneModel& bone, const std::string& name);

/// A structure and how far from it a voxel is.
struct NearestStructure {
  std::int32_t structure{-1};  // of the fields; -1: none within their reach
  float distance{0.0F};        // between centres of voxels [m]
};

/// The nearest of several structures; of equally near ones the first. Any thread.
/// @param fields  one for each structure
NearestStructure nearest_structure(std::span<const std::shared_ptr<const DistanceField>> fields,
                                   const Voxel& voxel) noexcept;

}  // namespace haptrial::bone
