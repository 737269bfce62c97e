#pragma once

#include <cstdint>

#include "core/bone/model/bone_model.h"
#include "core/geometry/mesh/work.h"

namespace haptrial::bone {

struct MandibleOptions {
  std::uint64_t seed{1};   // of the anatomy: size, angles, place of the nerve, teeth
  double spacing{0.5e-3};  // edge of a voxel, 0.2e-3 to 2e-3 [m]
  int threads{0};          // 0: one per processor; the bone is the same

  friend bool operator==(const MandibleOptions&, const MandibleOptions&) = default;
};

/// A whole mandible made from shapes, in the frame B (LPS: x to the left, y to the back, z up):
/// cortex and marrow, the inferior alveolar nerve of both sides in its canal, and teeth with their
/// roots, with the labels of anatomy.h. Lengths are those of anatomy texts:
/// docs/algorithms/procedural-bones.md.
/// @throws InputError unless the spacing is allowed; geometry::Cancelled.
BoneModel make_mandible(const MandibleOptions& options = {},
                        const geometry::WorkReport& report = {});

}  // namespace haptrial::bone
