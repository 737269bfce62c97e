#include <fmt/format.h>

#include <filesystem>

#include "core/base/error.h"
#include "core/render/gl/image.h"
#include "experiments/command/arguments.h"
#include "experiments/command/drilling/drilling_commands.h"
#include "protocols/bone_drilling/display/placement_legend.h"
#include "protocols/bone_drilling/display/placement_picture.h"

namespace haptrial::experiments {

int bone_place(const BonePlaceOptions& options) {
  if (std::filesystem::path(options.out).extension() != ".png") {
    throw InputError(fmt::format("{}: is not a picture by its name; allowed: .png", options.out));
  }
  if (!options.overwrite && std::filesystem::exists(options.out)) {
    throw InputError(
        fmt::format("{}: exists already; choose another name or add --overwrite", options.out));
  }
  const protocols::BoneDefinition definition = protocols::load_bone_definition(options.definition);
  const int number =
      checked_number("--bone", options.bone, 1, static_cast<int>(definition.bones.size()));
  const auto index = static_cast<std::size_t>(number - 1);
  const bone::BoneModel& model = *definition.bones[index];
  render::write_png(options.out, protocols::placement_picture(definition, index));
  fmt::print("bone        {}\nside        {}\n", model.name,
             protocols::placement_words(definition, model));
  for (const protocols::PlacedStructure& one : protocols::placed_structures(
           definition, model, definition.display.width, definition.display.height)) {
    if (!one.in_sight) {
      fmt::print("out of sight  {}\n", one.name);
    }
  }
  if (!bone::has_vital_structures(model)) {
    fmt::print("WARNING: vital structures are unknown: no injury can be told in this bone\n");
  }
  fmt::print("wrote       {}\n", options.out);
  return 0;
}

}  // namespace haptrial::experiments
