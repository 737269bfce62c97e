#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "core/bone/data/ear_anatomy.h"
#include "core/bone/model/bone_model.h"
#include "core/geometry/mesh/work.h"

namespace haptrial::bone {

/// The size of a bone that is made: millimetres of its shapes, and metres of the result.
struct MadeGrid {
  Point low;       // corner of the box [mm]
  Point high;      // the opposite one [mm]
  double scale;    // what is 1 mm in the shapes has this many [mm]
  double spacing;  // [m]
  int threads;     // 0: one per processor
  const char* name;
};

/// Asks a bone made from shapes for what every voxel holds; rows in parallel, the same bytes on
/// any number of threads. Densities are n/255.
BoneModel fill(const MadeGrid& made,
               const std::function<EarAnatomy::Material(const Point&)>& material,
               const geometry::WorkReport& report);

struct MandibleOptions {
  std::uint64_t seed{1};   // of the anatomy: size, angles, place of the nerve, teeth
  double spacing{0.5e-3};  // edge of a voxel, 0.2e-3 to 2e-3 [m]
  int threads{0};          // 0: one per processor; the bone is the same

  bool operator==(const MandibleOptions&) const = default;
};

/// A whole mandible made from shapes, in the frame B (LPS: x to the left, y to the back, z up):
/// cortex and marrow, the inferior alveolar nerve of both sides in its canal, and teeth with their
/// roots, with the labels of anatomy.h. Lengths are those of anatomy texts:
/// docs/algorithms/procedural-bones.md.
/// @throws InputError unless the spacing is allowed; geometry::Cancelled.
BoneModel make_mandible(const MandibleOptions& options = {},
                        const geometry::WorkReport& report = {});

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
