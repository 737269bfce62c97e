#include "experiments/experiment.h"

#include <array>
#include <fstream>
#include <string_view>
#include <system_error>

#include "core/base/error.h"
#include "core/base/table.h"

namespace haptrial::experiments {
namespace {

void refuse_session(const std::filesystem::path& file) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) {
    return;  // a pipe would wait here; Table::load() refuses it
  }
  std::array<char, 8> first{};
  std::ifstream(file, std::ios::binary).read(first.data(), first.size());
  if (std::string_view(first.data(), first.size()) == "\x89HDF\r\n\x1a\n") {
    throw InputError(file.string() + ": is a session file; give a definition (.toml)");
  }
}

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
  refuse_session(file);
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
