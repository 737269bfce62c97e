#include "analysis/bone_drilling/metrics/study_bones.h"

#include <algorithm>
#include <utility>

namespace haptrial::analysis::drilling {
namespace {

bool same(const bone::Structure& a, const bone::Structure& b) {
  return a.name == b.name && a.colour == b.colour && a.hardness == b.hardness && a.vital == b.vital;
}

bool same(const bone::BoneModel& a, const bone::BoneModel& b) {
  return a.name == b.name && a.source == b.source && a.grid.size == b.grid.size &&
         a.grid.origin == b.grid.origin && a.grid.spacing == b.grid.spacing &&
         a.labels == b.labels && a.density == b.density &&
         std::equal(a.structures.begin(), a.structures.end(), b.structures.begin(),
                    b.structures.end(),
                    [](const bone::Structure& x, const bone::Structure& y) { return same(x, y); });
}

/// The voxels without bone that hang together, through faces, with the outside of the grid.
std::vector<bool> open_air(const bone::BoneModel& bone) {
  const geometry::VoxelGrid& grid = bone.grid;
  std::vector<bool> open(grid.count(), false);
  std::vector<Eigen::Vector3i> todo;
  const auto visit = [&](const Eigen::Vector3i& v) {
    const bool inside = grid.contains(v);
    const std::size_t at = inside ? grid.index(v) : 0;
    if (inside && bone.labels[at] == 0 && !open[at]) {
      open[at] = true;
      todo.push_back(v);
    }
  };
  for (int axis = 0; axis < 3; ++axis) {
    const int one = (axis + 1) % 3, other = (axis + 2) % 3;
    for (int i = 0; i < grid.size[static_cast<std::size_t>(one)]; ++i) {
      for (int j = 0; j < grid.size[static_cast<std::size_t>(other)]; ++j) {
        for (const int end : {0, grid.size[static_cast<std::size_t>(axis)] - 1}) {
          Eigen::Vector3i v;
          v[axis] = end;
          v[one] = i;
          v[other] = j;
          visit(v);
        }
      }
    }
  }
  while (!todo.empty()) {
    const Eigen::Vector3i v = todo.back();
    todo.pop_back();
    for (int axis = 0; axis < 3; ++axis) {
      visit(v + Eigen::Vector3i::Unit(axis));
      visit(v - Eigen::Vector3i::Unit(axis));
    }
  }
  return open;
}

/// A bone whose only structures are the air around it, label 1, and all else, label 2.
bone::BoneModel in_air(const bone::BoneModel& bone) {
  const std::vector<bool> open = open_air(bone);
  bone::BoneModel model;
  model.grid = bone.grid;
  model.structures = {{}, {"air"}, {"bone"}};
  model.labels.resize(open.size());
  for (std::size_t at = 0; at < open.size(); ++at) {
    model.labels[at] = open[at] ? 1 : 2;
  }
  return model;
}

}  // namespace

std::shared_ptr<const bone::BoneModel> StudyBones::keep(bone::BoneModel bone) {
  const std::lock_guard lock(mutex_);
  for (const auto& kept : bones_) {
    if (same(*kept, bone)) {
      return kept;
    }
  }
  bones_.push_back(std::make_shared<const bone::BoneModel>(std::move(bone)));
  return bones_.back();
}

std::shared_ptr<const bone::DistanceField> StudyBones::field(
    const std::shared_ptr<const bone::BoneModel>& bone, std::uint8_t label, double reach) {
  std::vector<bool> labels(bone->structures.size(), false);
  labels.at(label) = true;
  return field(bone, labels, reach);
}

std::shared_ptr<const bone::DistanceField> StudyBones::field(
    const std::shared_ptr<const bone::BoneModel>& bone, const std::vector<bool>& labels,
    double reach) {
  // Made under the lock: several threads ask for the same field at once, and one has to make it.
  const std::lock_guard lock(mutex_);
  auto& field = fields_[Key(bone, labels, reach)];
  if (field == nullptr) {
    field = std::make_shared<const bone::DistanceField>(*bone, labels, reach);
  }
  return field;
}

std::shared_ptr<const bone::DistanceField> StudyBones::air_around(
    const std::shared_ptr<const bone::BoneModel>& bone, double reach) {
  const std::lock_guard lock(mutex_);  // likewise
  auto& field = air_[Key(bone, {}, reach)];
  if (field == nullptr) {
    field = std::make_shared<const bone::DistanceField>(in_air(*bone),
                                                        std::vector<bool>{false, true}, reach);
  }
  return field;
}

}  // namespace haptrial::analysis::drilling
