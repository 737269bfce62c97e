#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/render/gl/colour.h"
#include "core/render/gl/gl.h"
#include "protocols/bone_drilling/display/placed_bone.h"

namespace haptrial::protocols {

/// A structure of a bone where the first picture of a procedure has it.
struct PlacedStructure {
  std::string name;
  render::Colour colour;
  Eigen::Vector2d pixel;  // of its voxel that is nearest to its middle, from the top left [px]
  bool in_sight{false};   // within the picture
};

/// All that has voxels but plain bone, by label.
std::vector<PlacedStructure> placed_structures(const PlacedBone& bone);

/// Moves words down that would lie on one another, from top to bottom.
/// @param places  where the words begin [px]
/// @param row     height of a line; words at places that are nearer than `wide` share lines [px]
void set_words_apart(std::span<Eigen::Vector2d> places, double row, double wide);

/// Which ear a bone is and how it is placed: "a left ear by its structures; placed as ...".
std::string placement_words(const PlacedBone& bone);

/// Draws over a picture what is said of it: names with lines to their structures, the side and the
/// cavity in words, arrows of the patient's axes, and a bar for the scale at the depth of the
/// camera's target. Thread with the context of OpenGL.
void draw_placement_legend(const render::Gl& gl, const PlacedBone& bone);

}  // namespace haptrial::protocols
