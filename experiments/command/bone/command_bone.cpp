#include <CLI/CLI.hpp>

#include "experiments/command/subcommand.h"

namespace haptrial::experiments {

void add_bone(CLI::App& app, int& status) {
  CLI::App* bone =
      subcommand(app, "bone", "Import, make, draw and describe bones",
                 "haptrial bone make temporal ear.nrrd --seed 3", {"", "guide-bone.md"});
  bone->require_subcommand(1);
  add_bone_import(*bone, status);
  add_bone_atlas(*bone, status);
  add_bone_info(*bone, status);
  add_bone_structures(*bone, status);
  add_bone_export(*bone, status);
  add_bone_make(*bone, status);
  add_bone_picture(*bone, status);
  add_bone_stages(*bone, status);
  add_bone_place(*bone, status);
  add_bone_page(*bone, status);
  add_bone_fit_feel(*bone, status);
  add_bone_safe(*bone, status);
  add_bone_score(*bone, status);
  add_bone_phases(*bone, status);
  add_bone_class(*bone, status);
}

}  // namespace haptrial::experiments
