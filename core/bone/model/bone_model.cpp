#include "core/bone/model/bone_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace haptrial::bone {

void check(const BoneModel& model) {
  const std::size_t count = model.grid.count();
  if (model.labels.size() != count || (!model.density.empty() && model.density.size() != count)) {
    throw std::invalid_argument(fmt::format("bone model: {} labels and {} densities for {} voxels",
                                            model.labels.size(), model.density.size(), count));
  }
  if (!(model.grid.spacing > 0.0)) {
    throw std::invalid_argument("bone model: the spacing must be above 0");
  }
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint8_t label = model.labels[i];
    if (label != 0 && label >= model.structures.size()) {
      throw std::invalid_argument(
          fmt::format("bone model: label {} has no structure", static_cast<int>(label)));
    }
    if (!model.density.empty()) {
      const float density = model.density[i];
      if (!(density >= 0.0F && density <= 1.0F) || (density > 0.0F) != (label != 0)) {
        throw std::invalid_argument(fmt::format(
            "bone model: density {} with label {} in voxel {}; a label goes with a density above "
            "0 and at most 1",
            density, static_cast<int>(label), i));
      }
    }
  }
}

bool has_vital_structures(const BoneModel& model) {
  return std::any_of(model.labels.begin(), model.labels.end(), [&](std::uint8_t label) {
    return label < model.structures.size() && model.structures[label].vital;
  });
}

}  // namespace haptrial::bone
