#pragma once

#include "core/render/gl/image.h"
#include "protocols/bone_drilling/display/placement_legend.h"

namespace haptrial::protocols {

/// A bone as a procedure's first picture shows it, with what its teacher wants to know before:
/// structures and the cavity that is asked for show through in their colours, with their names;
/// words say which side it is; arrows show the patient's axes, and a bar the scale at the depth of
/// the camera's target.
/// @throws RunError without OpenGL.
render::Image placement_picture(const PlacedBone& bone);

}  // namespace haptrial::protocols
