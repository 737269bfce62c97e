#include "core/bone/data/mandible.h"

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/bone/data/jaw_anatomy.h"
#include "core/bone/data/procedural_bone.h"

namespace haptrial::bone {

BoneModel make_mandible(const MandibleOptions& options, const geometry::WorkReport& report) {
  if (!(options.spacing >= 0.2e-3 && options.spacing <= 2e-3)) {
    throw InputError(
        fmt::format("the spacing is {:.4g} mm; allowed: 0.2 to 2 mm", 1e3 * options.spacing));
  }
  const JawVariation variation = jaw_variation(options.seed);
  // A tube whose radius is more than half a voxel's diagonal has no gaps.
  const double least = 0.9 * 1e3 * options.spacing / variation.scale;
  const JawAnatomy anatomy(variation, least);
  const MadeGrid made{JawAnatomy::low(), JawAnatomy::high(), variation.scale,
                      options.spacing,   options.threads,    "mandible"};
  BoneModel model = fill(
      made, [&](const Point& p) { return anatomy.at(p); }, report);
  model.source = fmt::format("made by haptrial: mandible, seed {}, {:.4g} mm", options.seed,
                             1e3 * options.spacing);
  return model;
}

}  // namespace haptrial::bone
