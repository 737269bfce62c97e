#include "protocols/bone_drilling/drilled_bone.h"

#include <fmt/format.h>

#include <array>
#include <utility>

#include "core/base/error.h"
#include "core/bone/data/added_structures.h"

namespace haptrial::protocols {
namespace {

const std::array<double, 3> kRemovedBone{0.95, 0.25, 0.20};
const std::array<double, 3> kRemovedStructure{1.0, 0.0, 0.85};  // an injury is to be seen

/// The label for what was removed of a structure.
std::uint8_t label_of_removed(const bone::Structure& of, bone::BoneModel& model) {
  bone::Structure removed;
  const bool plain = of.name == bone::kPlainBone;
  removed.name = plain ? "removed" : "removed " + of.name;
  removed.colour = plain ? kRemovedBone : kRemovedStructure;
  return bone::label_for(removed, model);
}

}  // namespace

DrilledBone drilled_bone(const BoneReplay& replay, int trial, const BoneReplay::Pulse& pulse) {
  DrilledBone drilled;
  drilled.stage = replay.restore(trial, replay.last_bone(trial), drilled.verdict, pulse);
  if (!drilled.verdict.difference.empty()) {
    throw InputError(
        fmt::format("trial {} cannot be repeated: {}", trial, drilled.verdict.difference));
  }
  const bone::BoneModel& before = *drilled.stage->model;
  const bone::BoneWorld& world = std::as_const(*drilled.stage->simulator).world();
  bone::BoneModel& marked = drilled.marked;
  marked = before;
  marked.density.clear();
  marked.source += fmt::format("; after trial {}", trial);
  std::array<std::size_t, 256> counts{};
  std::array<std::uint8_t, 256> labels{};
  geometry::visit_voxels(before.grid, [&](const bone::Voxel& voxel, std::size_t at) {
    const std::uint8_t label = before.labels[at];
    if (label == 0 || world.holder(voxel) >= 0) {
      return;
    }
    if (counts[label]++ == 0) {
      labels[label] = label_of_removed(before.structures[label], marked);
    }
    marked.labels[at] = labels[label];
  });
  for (std::size_t label = 1; label < before.structures.size(); ++label) {
    if (counts[label] > 0) {
      const bone::Structure& structure = before.structures[label];
      drilled.removed.push_back({structure.name, counts[label], structure.vital});
    }
  }
  return drilled;
}

}  // namespace haptrial::protocols
