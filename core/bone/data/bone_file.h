#pragma once

#include <filesystem>

#include "core/bone/model/bone_model.h"

namespace haptrial::bone {

/// Writes a bone whole or not at all, as NRRD with gzip (.nrrd; as .seg.nrrd 3D Slicer shows it as
/// a segmentation): one byte per voxel, its label, and where densities differ a second one, the
/// density times 255, rounded up. Names, colours, hardness and what is vital are key/values.
/// load_bone() gives back the same bytes for densities that are n/255.
/// @throws InputError for another ending, or where the file is there or cannot be made; RunError
/// when writing fails; std::invalid_argument as check() does.
void save_bone(const std::filesystem::path& file, const BoneModel& model, bool overwrite = false);

}  // namespace haptrial::bone
