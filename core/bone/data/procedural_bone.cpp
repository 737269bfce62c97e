#include "core/bone/data/procedural_bone.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/error.h"
#include "core/base/nearest.h"
#include "core/base/parallel.h"
#include "core/bone/data/anatomy.h"
#include "core/bone/data/jaw_anatomy.h"

namespace haptrial::bone {

BoneModel fill(const MadeGrid& made,
               const std::function<EarAnatomy::Material(const Point&)>& material,
               const geometry::WorkReport& report) {
  BoneModel model;
  model.name = made.name;
  model.structures = known_structures();
  geometry::VoxelGrid& grid = model.grid;
  grid.spacing = made.spacing;
  const Point size = 1e-3 * made.scale * (made.high - made.low);
  for (int axis = 0; axis < 3; ++axis) {
    grid.size[static_cast<std::size_t>(axis)] =
        static_cast<std::int32_t>(std::ceil(size[axis] / grid.spacing));
    grid.origin[axis] = 1e-3 * made.scale * made.low[axis] + 0.5 * grid.spacing;
  }
  model.labels.assign(grid.count(), 0);
  model.density.assign(grid.count(), 0.0F);
  const int threads = threads_or_all(made.threads);
  for (std::int32_t k = 0; k < grid.size[2]; ++k) {
    parallel_for(static_cast<std::size_t>(grid.size[1]), threads, [&](std::size_t row) {
      const auto j = static_cast<std::int32_t>(row);
      for (std::int32_t i = 0; i < grid.size[0]; ++i) {
        const Point p = grid.centre(i, j, k) * (1e3 / made.scale);
        const EarAnatomy::Material found = material(p);
        if (found.label == Anatomy::kNothing) {
          continue;
        }
        const std::size_t index = grid.index(i, j, k);
        model.labels[index] = static_cast<std::uint8_t>(found.label);
        const double level = std::clamp(std::floor(255.0 * found.density + 0.5), 1.0, 255.0);
        model.density[index] = static_cast<float>(level) / 255.0F;
      }
    });
    geometry::report_share(report, (k + 1.0) / grid.size[2]);
  }
  return model;
}

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

namespace {

void lower_tegmen(EarVariation& v) { v.mastoid_roof = 6.0; }
void bring_sinus_forward(EarVariation& v) { v.sinus = 6.5; }
void shrink_antrum(EarVariation& v) { v.antrum = 0.6; }
void bare_nerve(EarVariation& v) { v.bare_nerve = true; }
void fill_cells(EarVariation& v) {
  v.cells = 0.0;
  v.spongy = 1.0;
}

constexpr std::array kVariants{
    EarVariant{"low tegmen", lower_tegmen}, EarVariant{"forward sinus", bring_sinus_forward},
    EarVariant{"small antrum", shrink_antrum}, EarVariant{"dehiscent facial nerve", bare_nerve},
    EarVariant{"sclerotic mastoid", fill_cells}};

}  // namespace

std::vector<std::string> ear_variants() {
  std::vector<std::string> names;
  for (const EarVariant& variant : kVariants) {
    names.emplace_back(variant.name);
  }
  return names;
}

void apply_ear_variant(std::string_view variant, EarVariation& variation) {
  if (variant.empty()) {
    return;
  }
  const auto found = std::find_if(kVariants.begin(), kVariants.end(),
                                  [&](const EarVariant& one) { return one.name == variant; });
  if (found == kVariants.end()) {
    throw InputError(not_allowed("the variant of the temporal bone", fmt::format("'{}'", variant),
                                 ear_variants()));
  }
  found->change(variation);
}

}  // namespace haptrial::bone
