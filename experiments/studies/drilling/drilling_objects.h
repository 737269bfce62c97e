#pragma once

#include <memory>
#include <vector>

#include "experiments/preview/space_objects.h"
#include "protocols/bone_drilling/display/placed_bone.h"

namespace haptrial::experiments {

/// The bone and each of its structures as lines where a hand feels them, in W. Made when it is
/// first asked for; takes a second for a large bone.
/// @param scale  from lengths of the bone to those of the hand
std::shared_ptr<const std::vector<SpaceObject>> objects_of(const protocols::PlacedBone& bone,
                                                           double scale);

}  // namespace haptrial::experiments
