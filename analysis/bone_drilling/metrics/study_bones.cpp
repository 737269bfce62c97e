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

}  // namespace haptrial::analysis::drilling
