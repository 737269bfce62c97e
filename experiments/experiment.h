#pragma once

#include <filesystem>
#include <optional>

#include "experiments/bone_definition.h"
#include "experiments/definition.h"

namespace haptrial::experiments {

/// A definition of whichever protocol its [experiment] names: "force_training", which may be left
/// out, or "bone_drilling".
struct Experiment {
  std::optional<Definition> force;  // one of the two is there
  std::optional<BoneDefinition> bone;

  const Setup& setup() const { return bone ? static_cast<const Setup&>(*bone) : *force; }
};

/// @throws InputError with a sentence for every problem of the file.
Experiment load_experiment(const std::filesystem::path& file);

/// Whether a definition's text, as a session file keeps it, is of drillings.
bool is_bone_definition(std::string_view text, std::string_view file_name);

}  // namespace haptrial::experiments
