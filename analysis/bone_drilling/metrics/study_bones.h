#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <tuple>
#include <vector>

#include "core/bone/model/bone_model.h"
#include "core/bone/model/distance_field.h"

namespace haptrial::analysis::drilling {

/// The bones of a study and the distance fields of their structures, each kept once. Any thread.
class StudyBones {
 public:
  /// @returns the kept bone that equals this one, which is kept where there is none
  std::shared_ptr<const bone::BoneModel> keep(bone::BoneModel bone);

  /// Distances to a structure, made when they are first asked for.
  /// @param reach  of the field [m]
  std::shared_ptr<const bone::DistanceField> field(
      const std::shared_ptr<const bone::BoneModel>& bone, std::uint8_t label, double reach);
  /// Distances to all of a set of labels.
  std::shared_ptr<const bone::DistanceField> field(
      const std::shared_ptr<const bone::BoneModel>& bone, const std::vector<bool>& labels,
      double reach);
  /// Distances to the air around a bone as it was made: in bone, the depth below its surface. Cells
  /// that are closed off count as bone.
  std::shared_ptr<const bone::DistanceField> air_around(
      const std::shared_ptr<const bone::BoneModel>& bone, double reach);

 private:
  using Key = std::tuple<std::shared_ptr<const bone::BoneModel>, std::vector<bool>, double>;

  std::mutex mutex_;
  std::vector<std::shared_ptr<const bone::BoneModel>> bones_;
  std::map<Key, std::shared_ptr<const bone::DistanceField>> fields_;
  std::map<Key, std::shared_ptr<const bone::DistanceField>> air_;  // without labels
};

}  // namespace haptrial::analysis::drilling
