#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "core/bone/model/bone_model.h"
#include "core/render/bone/bone_scene.h"

namespace haptrial::render {

/// A bone in an operation lies in a wound: retracted muscle, fat and skin cover it around the
/// field, and drapes the rest. All this is only seen, never felt. The opening is an
/// ellipse about the camera's target that follows the picture's height; the tissue lies on the
/// bone, and beside it at most 8 mm deeper than the bone in the field.
/// @param X_WB  pose of the bone  @param view  of the microscope at the start
std::vector<SceneMesh> surgical_field(const bone::BoneModel& model, const Eigen::Isometry3d& X_WB,
                                      const Camera& view);

}  // namespace haptrial::render
