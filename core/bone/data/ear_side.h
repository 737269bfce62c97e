#pragma once

#include <Eigen/Core>
#include <optional>

#include "core/bone/model/bone_model.h"

namespace haptrial::bone {

enum class EarSide { kRight, kLeft };

/// Directions of an ear in its bone's frame, unit length.
struct EarDirections {
  Eigen::Vector3d outwards;  // to the side of the head
  Eigen::Vector3d back;      // towards the sigmoid sinus; not square to outwards
};

/// Directions from the places of a temporal bone's structures: from the inner ear to the ear canal
/// it goes outwards, from there to the sigmoid sinus back. Nothing where these are not labelled.
std::optional<EarDirections> ear_directions(const BoneModel& model);

/// Side of an ear, if the axes are the patient's (x to the left): outwards it goes to the right or
/// to the left. Nothing where the structures do not say, or lie along no such axis.
std::optional<EarSide> ear_side(const BoneModel& model);

/// Direction from which an ear is seen from outside, a little from the back and from above; a right
/// ear if the structures do not say.
Eigen::Vector3d outside_view(const BoneModel& model);

/// The same bone with left and right exchanged: a left ear becomes a right one.
BoneModel mirrored(const BoneModel& model);

}  // namespace haptrial::bone
