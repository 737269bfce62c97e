#include <CLI/CLI.hpp>

#include "experiments/command/bone/bone_options.h"
#include "experiments/command/subcommand.h"

namespace haptrial::experiments {
namespace {

int bone_info(const BoneInput& options) {
  const MemoryBudget budget(options.max_memory);
  const bone::LoadOptions load = load_options(options, budget);
  ShownWork work("reading");
  const bone::BoneModel model = bone::load_bone(options.in, load, work.report());
  print_bone(model);
  print_warnings(model);
  return 0;
}

}  // namespace

void add_bone_info(CLI::App& bone, int& status) {
  CLI::App* sub = subcommand(bone, "info", "Show what a bone holds, structure by structure",
                             "haptrial bone info ear.nrrd");
  add_bone_input(*sub, options_of<BoneInput>(*sub, status, bone_info));
}

}  // namespace haptrial::experiments
