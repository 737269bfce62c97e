#pragma once

#include <cstdint>
#include <optional>

#include "core/bone/model/bone_model.h"

namespace haptrial::bone {

/// A structure's labels beside its true ones.
struct LabelMatch {
  double dice{0.0};                // 2 |A and B| / (|A| + |B|), 0 to 1
  std::optional<double> distance;  // mean between the two surfaces, both ways; nothing if one is
                                   // empty or over 20 mm away [m]
  std::optional<double> held;      // share of the true voxels within the margin of the label
};

/// Compares one structure with its truth, which is sampled at the centres of the bone's voxels and
/// may have voxels of another size. Source: Dice 1945.
/// @param truth   in the same frame
/// @param margin  [m]; nothing: none is stated
/// @returns nothing where the truth has no such structure
std::optional<LabelMatch> compare_label(const BoneModel& model, std::uint8_t label,
                                        const BoneModel& truth, std::optional<double> margin);

}  // namespace haptrial::bone
