#pragma once

#include "core/bone/model/bone_model.h"

namespace haptrial::bone {

/// Whether a CT shows a structure as bone. Soft structures it does not, nor the labyrinth, which
/// fluid fills.
inline bool looks_like_bone(const Structure& structure) {
  return structure.hardness >= 1.0 && structure.name != "bony labyrinth";
}

}  // namespace haptrial::bone
