#pragma once

#include <cstdint>
#include <string>

#include "core/bone/model/bone_model.h"
#include "core/geometry/mesh/work.h"

namespace haptrial::bone {

struct TemporalBoneOptions {
  std::uint64_t seed{1};   // of the anatomy: size, cells, sinus, tegmen, nerve
  std::string variant{};   // of ear_variants(); "": none
  double spacing{0.5e-3};  // edge of a voxel, 0.1e-3 to 2e-3 [m]
  int threads{0};          // 0: one per processor; the bone is the same

  bool operator==(const TemporalBoneOptions&) const = default;
};

/// A right temporal bone made from shapes, about 55 x 67 x 69 mm, in the frame B (LPS: x from the
/// side of the head inwards, y to the back, z up), with the labels of anatomy.h. Lengths and
/// places are those of anatomy texts, with their variation: docs/algorithms/procedural-bones.md.
/// @throws InputError unless spacing and variant are allowed; geometry::Cancelled.
BoneModel make_temporal_bone(const TemporalBoneOptions& options = {},
                             const geometry::WorkReport& report = {});

}  // namespace haptrial::bone
