#include "core/bone/model/tidy.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/bone/model/bone_volume.h"
#include "core/bone/model/flood.h"
#include "core/bone/model/occupancy.h"

namespace haptrial::bone {
namespace {

constexpr float kLowestDensity = 51.0F / 255.0F;  // of bone at the threshold of a scan

/// A part of the empty voxels.
struct Hole {
  std::vector<std::size_t> voxels;  // as long as it may be filled
  std::array<std::size_t, 256> around{};
  bool open{false};
};

/// Floods empty voxels of a grid through their faces, each once.
class Emptiness {
 public:
  Emptiness(const BoneModel& model, std::size_t most)
      : model_(model), most_(most), seen_(model.labels.size(), 0) {}

  bool is_new(std::size_t at) const { return model_.labels[at] == 0 && seen_[at] == 0; }

  Hole flood(std::size_t from) {
    Hole hole;
    stack_.assign(1, from);
    seen_[from] = 1;
    while (!stack_.empty()) {
      const std::size_t at = stack_.back();
      stack_.pop_back();
      if (!hole.open) {
        hole.voxels.push_back(at);
        hole.open = hole.voxels.size() > most_;
      }
      visit_neighbours(at, hole);
    }
    return hole;
  }

 private:
  void visit_neighbours(std::size_t at, Hole& hole) {
    std::size_t rest = at;
    std::size_t stride = 1;
    for (const std::int32_t length : model_.grid.size) {
      const auto size = static_cast<std::size_t>(length);
      const std::size_t place = rest % size;
      rest /= size;
      hole.open = hole.open || place == 0 || place + 1 == size;
      if (place > 0) {
        visit(at - stride, hole);
      }
      if (place + 1 < size) {
        visit(at + stride, hole);
      }
      stride *= size;
    }
  }
  void visit(std::size_t at, Hole& hole) {
    if (model_.labels[at] != 0) {
      ++hole.around[model_.labels[at]];
    } else if (seen_[at] == 0) {
      seen_[at] = 1;
      stack_.push_back(at);
    }
  }

  const BoneModel& model_;
  std::size_t most_;
  std::vector<std::uint8_t> seen_;
  std::vector<std::size_t> stack_;
};

}  // namespace

TidyResult keep_largest_part(BoneModel& model) {
  const BoneVolume volume(model);
  Occupancy occupancy;
  occupancy.follow(volume);
  Flood flood;
  flood.look(volume, occupancy);
  TidyResult tidied;
  for (const Part& part : flood.loose(volume)) {
    bool any = false;
    for (const Voxel& voxel : part) {
      const std::size_t at = model.grid.index(voxel);
      if (model.structures[model.labels[at]].name != "bone") {
        continue;
      }
      any = true;
      ++tidied.voxels;
      model.labels[at] = 0;
      if (!model.density.empty()) {
        model.density[at] = 0.0F;
      }
    }
    tidied.parts += any ? 1 : 0;
  }
  return tidied;
}

TidyResult fill_holes(BoneModel& model, std::size_t most_voxels) {
  Emptiness emptiness(model, most_voxels);
  TidyResult tidied;
  std::vector<std::pair<std::vector<std::size_t>, std::uint8_t>> holes;
  for (std::size_t at = 0; at < model.labels.size(); ++at) {
    if (!emptiness.is_new(at)) {
      continue;
    }
    Hole hole = emptiness.flood(at);
    if (!hole.open) {
      const auto most = std::ranges::max_element(hole.around) - hole.around.begin();
      holes.emplace_back(std::move(hole.voxels), static_cast<std::uint8_t>(most));
    }
  }
  for (const auto& [voxels, label] : holes) {
    ++tidied.parts;
    tidied.voxels += voxels.size();
    for (const std::size_t at : voxels) {
      model.labels[at] = label;
      if (!model.density.empty()) {
        model.density[at] = kLowestDensity;
      }
    }
  }
  return tidied;
}

}  // namespace haptrial::bone
