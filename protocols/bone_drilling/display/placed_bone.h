#pragma once

#include <cstddef>
#include <memory>
#include <string>

#include "core/base/camera.h"
#include "core/bone/model/bone_model.h"
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

}  // namespace haptrial::protocols
