#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/bone/bone_model.h"
#include "core/render/scene.h"

namespace haptrial::analysis::drilling {

/// What was removed as the source's Figure 18 shows it: voxels that were visible in green, those
/// that other bone hid in red, and some structures as they were at first in their own colours. Bone
/// is not drawn. Triangles in the bone frame B, for render::draw_scene.
/// @param removed, seen  of a ProcedureSummary
/// @param labels         by label: whether the structure is drawn
/// @throws std::invalid_argument where the lengths differ or a voxel is outside of the grid.
/// Source: Morris 2006, §3.5.1.
std::vector<render::SceneTriangle> visibility_scene(const bone::BoneModel& bone,
                                                    std::span<const std::uint32_t> removed,
                                                    std::span<const std::uint8_t> seen,
                                                    const std::vector<bool>& labels);

/// Labels of the structures that are vital.
std::vector<bool> vital_labels(const bone::BoneModel& bone);

}  // namespace haptrial::analysis::drilling
