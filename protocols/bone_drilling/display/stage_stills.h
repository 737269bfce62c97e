#pragma once

#include <memory>
#include <vector>

#include "core/render/gl/image.h"
#include "protocols/bone_drilling/definition/bone_definition.h"

namespace haptrial::protocols {

/// A bone as it should look when so much of the cavity's depth is done.
struct StageStill {
  double share{0.0};  // of the depth of the cavity, 0 to 1
  render::Image image;
};

/// Stills of the first bone of a definition at evenly spaced stages, the untouched bone first and
/// the finished cavity last, seen from where a procedure begins. The plan is taken away layer by
/// layer from the outside, as far as the smallest burr reaches. Source: Morris 2006, Figure 15.
/// @param stages  at least 2
/// @throws InputError where the definition has no [cavity]; RunError without OpenGL.
std::vector<StageStill> stage_stills(const BoneDefinition& definition, int stages);

/// The stills that a participant can call up, of [display]: null where it asks for none. They are
/// made of a bone with the definition's cavity, half as wide and high as its pictures.
/// Takes seconds. @throws InputError as make_chart does; RunError without OpenGL.
std::shared_ptr<const std::vector<render::Image>> screen_stills(const BoneDefinition& definition,
                                                                const bone::BoneModel& model);

}  // namespace haptrial::protocols
