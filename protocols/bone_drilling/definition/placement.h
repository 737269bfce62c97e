#pragma once

#include <Eigen/Geometry>

#include "core/base/camera.h"
#include "core/base/definition/schema_forward.h"
#include "core/bone/model/bone_model.h"

namespace haptrial::subject {
struct CavityParameters;
}

namespace haptrial::protocols {

/// How a bone lies in the scene.
struct BonePlacement {
  Eigen::Vector3d centre{Eigen::Vector3d::Zero()};    // of its grid, in W [m]
  Eigen::Matrix3d turn{Eigen::Matrix3d::Identity()};  // from B to W: a rotation
  bool left_ear{false};                               // as `place` says

  bool operator==(const BonePlacement&) const = default;
};
Eigen::Isometry3d pose_of(const BonePlacement& placement, const geometry::VoxelGrid& grid);

/// The keys of [bone] about its place: centre and either x_to and y_to, or `place`: "surgeon's view
/// of a right ear" (or left). The side of the head then faces up, its back the participant.
const Schema<BonePlacement>& placement_schema();

/// @param cavity  that is asked for; null: none
/// @throws InputError where a labelled ear lies so that the camera, or the cavity, would begin
/// inside the skull: on the wrong side of it, or in the bone.
void check_placement(const BonePlacement& placement, const bone::BoneModel& bone,
                     const Camera& camera, const subject::CavityParameters* cavity);

}  // namespace haptrial::protocols
