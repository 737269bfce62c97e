#include <fmt/format.h>

#include <string>

#include "core/base/error.h"
#include "core/base/nearest.h"
#include "core/bone/data/mandible.h"
#include "core/bone/data/temporal_bone.h"
#include "experiments/command/arguments.h"
#include "experiments/command/tools/bone_carving.h"
#include "experiments/command/tools/bone_words.h"
#include "experiments/command/tools/tool_commands.h"

namespace haptrial::experiments {

int bone_info(const BoneOptions& options) {
  const MemoryBudget budget(options.max_memory);
  const bone::LoadOptions load = load_options(options, budget);
  ShownWork work("reading");
  const bone::BoneModel model = bone::load_bone(options.in, load, work.report());
  print_bone(model);
  print_unknown(model);
  return 0;
}

int bone_make(const BoneOptions& options) {
  check_new_bone(options);
  if (options.shape != "temporal" && options.shape != "mandible") {
    throw InputError(
        not_allowed("the bone", fmt::format("'{}'", options.shape), {"temporal", "mandible"}));
  }
  const std::uint64_t seed = checked_seed(options.seed);
  const double spacing = options.spacing.value_or(0.5) * kMillimetre;
  ShownWork work("making");
  const bone::BoneModel model =
      options.shape == "temporal"
          ? bone::make_temporal_bone({.seed = seed, .spacing = spacing}, work.report())
          : bone::make_mandible({.seed = seed, .spacing = spacing}, work.report());
  save_new_bone(options, model);
  return 0;
}

}  // namespace haptrial::experiments
