#include "core/bone/data/temporal_bone.h"

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/bone/data/ear_anatomy.h"
#include "core/bone/data/ear_variants.h"
#include "core/bone/data/procedural_bone.h"

namespace haptrial::bone {

BoneModel make_temporal_bone(const TemporalBoneOptions& options,
                             const geometry::WorkReport& report) {
  if (!(options.spacing >= 0.1e-3 && options.spacing <= 2e-3)) {
    throw InputError(
        fmt::format("the spacing is {:.4g} mm; allowed: 0.1 to 2 mm", 1e3 * options.spacing));
  }
  EarVariation variation = ear_variation(options.seed);
  apply_ear_variant(options.variant, variation);
  // A tube whose radius is more than half a voxel's diagonal has no gaps.
  const double least = 0.9 * 1e3 * options.spacing / variation.scale;
  const EarAnatomy anatomy(variation, least);
  // Whole voxels around the box leave its middle and the places of the voxels in it alone.
  const double voxel = 1e3 * options.spacing / variation.scale;
  const Point around = voxel * (EarAnatomy::kAround / voxel).array().ceil().matrix();
  const MadeGrid made{-around,         Point::Constant(EarAnatomy::kBox) + around,
                      variation.scale, options.spacing,
                      options.threads, "temporal bone"};
  BoneModel model = fill(
      made, [&](const Point& p) { return anatomy.at(p); }, report);
  const std::string variant = options.variant.empty() ? "" : options.variant + ", ";
  model.source = fmt::format("made by haptrial: right temporal bone, {}seed {}, {:.4g} mm", variant,
                             options.seed, 1e3 * options.spacing);
  return model;
}

}  // namespace haptrial::bone
