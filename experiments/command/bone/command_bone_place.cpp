#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>

#include "core/base/error.h"
#include "core/render/gl/image.h"
#include "experiments/command/arguments.h"
#include "experiments/command/subcommand.h"
#include "protocols/bone_drilling/display/placement_legend.h"
#include "protocols/bone_drilling/display/placement_picture.h"
#include "protocols/bone_drilling/load_bones.h"

namespace haptrial::experiments {
namespace {

struct BonePlaceOptions {
  std::string definition;
  std::string out;
  int bone{1};
  bool overwrite{false};
};

int bone_place(const BonePlaceOptions& options) {
  if (std::filesystem::path(options.out).extension() != ".png") {
    throw InputError(fmt::format("{}: is not a picture by its name; allowed: .png", options.out));
  }
  check_new(options.out, options.overwrite);
  const protocols::BoneDefinition definition = protocols::load_bone_definition(options.definition);
  const int number =
      checked_number("--bone", options.bone, 1, static_cast<int>(definition.bones.size()));
  const protocols::PlacedBone bone =
      protocols::placed_bone(definition, static_cast<std::size_t>(number - 1));
  render::write_png(options.out, protocols::placement_picture(bone));
  fmt::print("bone        {}\nside        {}\n", bone.model->name,
             protocols::placement_words(bone));
  for (const protocols::PlacedStructure& one : protocols::placed_structures(bone)) {
    if (!one.in_sight) {
      fmt::print("out of sight  {}\n", one.name);
    }
  }
  if (!bone::has_vital_structures(*bone.model)) {
    fmt::print("WARNING: vital structures are unknown: no injury can be told in this bone\n");
  }
  fmt::print("wrote       {}\n", options.out);
  return 0;
}

}  // namespace

void add_bone_place(CLI::App& bone, int& status) {
  CLI::App* sub = subcommand(
      bone, "place", "Draw a bone as it lies before its first cut, with names",
      "haptrial bone place construct_validity placed.png", {"the picture OUT", "guide-scan.md"});
  auto& o = options_of<BonePlaceOptions>(*sub, status, bone_place);
  sub->add_option("DEFINITION", o.definition, "Definition of bone drilling (.toml)")->required();
  sub->add_option("OUT", o.out, "New picture (.png)")->required();
  sub->add_option("--bone", o.bone,
                  with_default("Number of the bone in the definition's list", o.bone));
  sub->add_flag("--overwrite", o.overwrite, "Overwrite an existing file");
}

}  // namespace haptrial::experiments
