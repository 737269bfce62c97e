#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/base/camera.h"
#include "core/bone/model/bone_model.h"
#include "core/render/gl/colour.h"
#include "core/render/gl/gl.h"
#include "core/subject/drilling/cavity_chart.h"
#include "protocols/bone_drilling/definition/bone_definition.h"
#include "protocols/bone_drilling/definition/placement.h"

namespace haptrial::protocols {

/// A bone as it lies before its first cut, and as the camera sees it then: all that its picture for
/// the teacher depends on.
struct PlacedBone {
  std::shared_ptr<const bone::BoneModel> model;
  BonePlacement placement;
  bool mirrored{false};                                  // left and right of the bone, as read
  Camera camera;                                         // of the first picture
  int width{0}, height{0};                               // of the picture [px]
  std::shared_ptr<const subject::DrillingChart> cavity;  // that is asked for; null: none
  std::string beside;                                    // structure that the cavity lies beside
  double burr{1.0};                                      // radius of the smallest burr [m]

  bool operator==(const PlacedBone&) const = default;
};

/// @param bone  of definition.bones
PlacedBone placed_bone(const BoneDefinition& definition, std::size_t bone);

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
