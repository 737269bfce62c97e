#include "core/bone/model/nearest_structure.h"

#include <algorithm>

namespace haptrial::bone {

std::vector<std::string> vital_structures(const BoneModel& bone) {
  std::vector<bool> there(256, false);
  for (const std::uint8_t label : bone.labels) {
    there[label] = true;
  }
  std::vector<std::string> names;
  for (std::size_t label = 1; label < bone.structures.size(); ++label) {
    const Structure& structure = bone.structures[label];
    if (structure.vital && there[label] &&
        std::find(names.begin(), names.end(), structure.name) == names.end()) {
      names.push_back(structure.name);
    }
  }
  return names;
}

std::vector<bool> labels_named(const BoneModel& bone, const std::string& name) {
  std::vector<bool> labels(bone.structures.size(), false);
  for (std::size_t label = 1; label < labels.size(); ++label) {
    labels[label] = bone.structures[label].name == name;
  }
  return labels;
}

NearestStructure nearest_structure(std::span<const std::shared_ptr<const DistanceField>> fields,
                                   const Voxel& voxel) noexcept {
  NearestStructure nearest;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const auto distance = fields[i]->at(voxel);
    if (distance && (nearest.structure < 0 || static_cast<float>(*distance) < nearest.distance)) {
      nearest = {static_cast<std::int32_t>(i), static_cast<float>(*distance)};
    }
  }
  return nearest;
}

}  // namespace haptrial::bone
