#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <string>

#include "core/base/error.h"
#include "core/base/nearest.h"
#include "core/bone/data/procedural_bone.h"
#include "experiments/command/arguments.h"
#include "experiments/command/bone/bone_carving.h"
#include "experiments/command/bone/bone_options.h"
#include "experiments/command/subcommand.h"

namespace haptrial::experiments {
namespace {

struct BoneMakeOptions : BoneOutput {
  std::string shape;
  std::string seed{"1"};
  std::string variant;
  double spacing{0.5};
};

int bone_make(const BoneMakeOptions& options) {
  check_new_bone(options);
  if (options.shape != "temporal" && options.shape != "mandible") {
    throw InputError(
        not_allowed("the bone", fmt::format("'{}'", options.shape), {"temporal", "mandible"}));
  }
  if (!options.variant.empty() && options.shape != "temporal") {
    throw InputError("--variant is about temporal bones; leave it out for a mandible");
  }
  const std::uint64_t seed = checked_seed(options.seed);
  const double spacing = options.spacing * kMillimetre;
  ShownWork work("making");
  const bone::BoneModel model =
      options.shape == "temporal"
          ? bone::make_temporal_bone({.seed = seed, .variant = options.variant, .spacing = spacing},
                                     work.report())
          : bone::make_mandible({.seed = seed, .spacing = spacing}, work.report());
  save_new_bone(options, model);
  return 0;
}

}  // namespace

void add_bone_make(CLI::App& bone, int& status) {
  CLI::App* sub = subcommand(bone, "make", "Make a bone from shapes and a seed",
                             "haptrial bone make mandible jaw.nrrd --seed 2 --spacing 0.5");
  auto& o = options_of<BoneMakeOptions>(*sub, status, bone_make);
  sub->add_option("BONE", o.shape, "Bone to make: temporal or mandible")->required();
  add_bone_output(*sub, o);
  sub->add_option("--seed", o.seed, with_default("Seed of the anatomy", o.seed));
  sub->add_option("--variant", o.variant,
                  fmt::format("Variant of a temporal bone: {} (default: none)",
                              fmt::join(bone::ear_variants(), ", ")));
  sub->add_option("--spacing", o.spacing, with_default("Edge of a voxel [mm]", o.spacing));
}

}  // namespace haptrial::experiments
