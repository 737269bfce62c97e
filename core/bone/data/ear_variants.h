#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/bone/data/ear_anatomy.h"

namespace haptrial::bone {

/// A named variant of temporal bones that makes a mastoidectomy harder. How far each deviates:
/// docs/algorithms/procedural-bones.md.
struct EarVariant {
  std::string_view name;
  void (*change)(EarVariation&);
};

/// Names of all variants.
std::vector<std::string> ear_variants();

/// @param variant  "" changes nothing
/// @throws InputError naming the variants if there is none of that name.
void apply_ear_variant(std::string_view variant, EarVariation& variation);

}  // namespace haptrial::bone
