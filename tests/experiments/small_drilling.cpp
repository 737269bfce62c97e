#include "tests/experiments/small_drilling.h"

#include <fmt/format.h>

#include <stdexcept>

#include "core/bone/data/bone_file.h"
#include "tests/experiments/shipped.h"

namespace haptrial::test {

std::string drilling_with(const std::vector<std::pair<std::string, std::string>>& lines) {
  std::string text =
      read_text(std::filesystem::path(HAPTRIAL_SOURCE_DIR) / "experiments" / "bone_drilling.toml");
  for (const auto& [key, line] : lines) {
    const std::size_t at = text.find("\n" + key + " =");
    if (at == std::string::npos) {
      throw std::invalid_argument("no line of the shipped definition starts with " + key);
    }
    const std::size_t end = text.find('\n', at + 1);
    text.replace(at + 1, end - at - 1, line);
  }
  return text;
}

bone::BoneModel two_slabs() {
  bone::BoneModel model;
  model.name = "slabs";
  model.source = "made by a test";
  model.grid = {{32, 12, 20}, {0.0, 0.0, 0.0}, 1e-3};
  model.labels.assign(model.grid.count(), 0);
  for (int k = 0; k < 20; ++k) {
    for (int j = 0; j < 12; ++j) {
      for (int i = 0; i < 32; ++i) {
        const bool slab = j < 6 || j >= 9;
        const bool post = (i == 15 || i == 16) && (k == 9 || k == 10);
        const bool nerve = j == 2 && k == 10;
        model.labels[model.grid.index(i, j, k)] = nerve ? 2 : slab || post ? 1 : 0;
      }
    }
  }
  model.structures = {
      {}, {"bone", {0.9, 0.87, 0.78}, 1.0, false}, {"facial nerve", {1.0, 0.9, 0.2}, 0.5, true}};
  return model;
}

bone::BoneModel slabs_over_dura() {
  bone::BoneModel model = two_slabs();
  for (std::size_t at = 0; at < model.labels.size(); ++at) {
    const int j = model.grid.voxel(at).y();
    model.labels[at] = j < 7 ? 2 : j >= 10 ? 1 : 0;
  }
  model.structures[2] = {"sigmoid sinus and dura", {0.32, 0.38, 0.75}, 0.25, true};
  return model;
}

std::filesystem::path write_small_drilling(
    const std::filesystem::path& folder, double seconds,
    const std::vector<std::pair<std::string, std::string>>& more) {
  bone::save_bone(folder / "slabs.nrrd", two_slabs());
  std::vector<std::pair<std::string, std::string>> lines{
      {"bones", "bones = [\"slabs.nrrd\"]"},
      {"centre", "centre = [0.0, 0.0, 0.0]"},
      {"x_to", "x_to = [1.0, 0.0, 0.0]"},
      {"y_to", "y_to = [0.0, 1.0, 0.0]"},
      {"time_limit", fmt::format("time_limit = {:.3f}", seconds)},
      {"card", "card = false"},
      {"start", "start = [0.0, 0.012, 0.0]"},
      {"width", "width = 0.008"},
      {"height", "height = 0.006"},
      // Voxels as coarse as these give way in steps; pressed harder the drill chatters into a stop.
      {"press", "press = 2.5"},
      {"depth", "depth = 0.009"},
      // Voxels as coarse as these give way in steps; pressed harder the drill chatters into a stop.
      {"press", "press = 2.5"},
      {"strokes_to_suction", "strokes_to_suction = 4"},
      {"suction_time", "suction_time = 0.5"}};
  lines.insert(lines.end(), more.begin(), more.end());
  std::string text = drilling_with(lines);
  // [display] has a width and a height too: those of the hand come first.
  write_text(folder / "study.toml", text);
  return folder / "study.toml";
}

}  // namespace haptrial::test
