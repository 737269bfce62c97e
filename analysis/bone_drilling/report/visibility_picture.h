#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "core/bone/model/bone_model.h"
#include "core/render/mesh/scene.h"

namespace haptrial::analysis::drilling {

/// Removed voxels, and whether they were seen. Source: Morris 2006, §3.5.1.
struct SeenRemovals {
  const bone::BoneModel* bone{nullptr};
  std::span<const std::uint32_t> removed;  // as ProcedureSummary has it
  std::span<const std::uint8_t> seen;      // (removed)
};

/// Place from which the removals are looked at.
struct SurgeonsView {
  Eigen::Vector3d towards_eye{Eigen::Vector3d::UnitZ()};  // in B, any length but 0
  Eigen::Vector3d up{Eigen::Vector3d::UnitY()};           // in the picture, in B, not along it
};

/// Green and magenta: no structure has them, and who does not tell red from green tells these.
inline constexpr render::Colour kSeenColour{0.13, 0.62, 0.32};
inline constexpr render::Colour kHiddenColour{0.86, 0.04, 0.66};

/// Voxels that were visible when they were removed in kSeenColour, those that other bone hid in
/// kHiddenColour, and some structures as they were at first in pale colours of their own. Bone is
/// not drawn. Triangles in the bone frame B, for render::draw_scene.
/// @param labels  by label: whether the structure is drawn
/// @throws std::invalid_argument where the lengths differ or a voxel is outside of the grid.
std::vector<render::SceneTriangle> visibility_scene(const SeenRemovals& removals,
                                                    const std::vector<bool>& labels);

/// A cut through one layer of voxels, with bone that stands in beige, what was removed in the
/// colours above, structures as they were at first in pale colours and air in white. The axis of
/// the grid that is closest to the way out points up; the layer is that with the most hidden
/// voxels, or, where nothing was hidden, with the most removed ones.
/// @param width, height  of the picture [px]; the cut is as large as fits in whole pixels a voxel
/// @throws std::invalid_argument as visibility_scene does, and where nothing was removed.
render::Image visibility_section(const SeenRemovals& removals, const Eigen::Vector3d& towards_eye,
                                 int width, int height);

/// The source's Figure 18: on the left the scene as the surgeon looks into it, without what is more
/// than 6 mm aside of the removed voxels; on the right the section. 2 x 560 by 520 pixels.
render::Image visibility_figure(const SeenRemovals& removals, const SurgeonsView& view);

/// Labels of the structures that are vital.
std::vector<bool> vital_labels(const bone::BoneModel& bone);

}  // namespace haptrial::analysis::drilling
