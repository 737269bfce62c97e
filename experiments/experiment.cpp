#include "experiments/experiment.h"

#include "core/base/table.h"

namespace haptrial::experiments {
namespace {

bool drills(Table& root) {
  if (!root.has("experiment")) {
    return false;
  }
  Table experiment = root.table("experiment");
  return experiment.has("protocol") &&
         experiment.choice("protocol", {"force_training", "bone_drilling"}) == "bone_drilling";
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
