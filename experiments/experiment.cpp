#include "experiments/experiment.h"

#include "core/base/table.h"

namespace haptrial::experiments {
namespace {

/// The protocol decides what the other keys mean, so a mistake in it is reported alone.
bool drills(Table& root) {
  if (root.misspelled("experiment")) {
    root.check();
  }
  Table experiment = root.table("experiment");
  const bool drills =
      !experiment.misspelled("protocol") && experiment.has("protocol") &&
      experiment.choice("protocol", {"force_training", "bone_drilling"}) == "bone_drilling";
  root.check();
  return drills;
}

}  // namespace

Experiment load_experiment(const std::filesystem::path& file) {
  const std::filesystem::path folder = file.parent_path();
  Table root = Table::load(file);
  Experiment experiment;
  if (drills(root)) {
    experiment.bone = read_bone_definition(root, file.string(), &folder);
  } else {
    experiment.force = read_definition(root, file.string(), &folder);
  }
  return experiment;
}

bool is_bone_definition(std::string_view text, std::string_view file_name) {
  Table root = Table::parse(text, file_name);
  return drills(root);
}

}  // namespace haptrial::experiments
