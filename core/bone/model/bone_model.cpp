#include "core/bone/model/bone_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

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

geometry::VoxelGrid grid_within(const geometry::VoxelGrid& grid, const Eigen::AlignedBox3d& box) {
  geometry::VoxelGrid part = grid;
  std::array<std::int32_t, 3> low{};
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    constexpr double kPlay = 1e-6;  // a centre on the border lies within [voxels]
    const double last = grid.size[a] - 1.0;
    const auto number = [&](double coordinate) {
      return std::clamp((coordinate - grid.origin[axis]) / grid.spacing, -1.0, last + 1.0);
    };
    low[a] = std::max(0, static_cast<std::int32_t>(std::ceil(number(box.min()[axis]) - kPlay)));
    const auto high =
        std::min(static_cast<std::int32_t>(last),
                 static_cast<std::int32_t>(std::floor(number(box.max()[axis]) + kPlay)));
    part.size[a] = std::max(0, high - low[a] + 1);
  }
  if (part.count() == 0) {
    part.size = {0, 0, 0};
    return part;
  }
  part.origin = grid.centre(low[0], low[1], low[2]);
  return part;
}

void crop_to_bone(BoneModel& model) {
  const geometry::VoxelGrid old = model.grid;
  std::array<std::int32_t, 3> low = old.size;
  std::array<std::int32_t, 3> high{-1, -1, -1};
  for (std::int32_t k = 0; k < old.size[2]; ++k) {
    for (std::int32_t j = 0; j < old.size[1]; ++j) {
      for (std::int32_t i = 0; i < old.size[0]; ++i) {
        if (model.labels[old.index(i, j, k)] == 0) {
          continue;
        }
        const std::array<std::int32_t, 3> voxel{i, j, k};
        for (std::size_t axis = 0; axis < 3; ++axis) {
          low[axis] = std::min(low[axis], voxel[axis]);
          high[axis] = std::max(high[axis], voxel[axis]);
        }
      }
    }
  }
  constexpr std::int32_t kMargin = 2;
  geometry::VoxelGrid grid = old;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    low[axis] = std::max(0, low[axis] - kMargin);
    grid.size[axis] = std::min(old.size[axis], high[axis] + kMargin + 1) - low[axis];
  }
  grid.origin = old.centre(low[0], low[1], low[2]);
  BoneModel cropped = model;
  cropped.grid = grid;
  cropped.labels.assign(grid.count(), 0);
  cropped.density.assign(model.density.empty() ? 0 : grid.count(), 0.0F);
  for (std::int32_t k = 0; k < grid.size[2]; ++k) {
    for (std::int32_t j = 0; j < grid.size[1]; ++j) {
      const std::size_t from = old.index(low[0], low[1] + j, low[2] + k);
      const auto to = static_cast<std::ptrdiff_t>(grid.index(0, j, k));
      const auto length = static_cast<std::size_t>(grid.size[0]);
      std::copy_n(model.labels.data() + from, length, cropped.labels.begin() + to);
      if (!model.density.empty()) {
        std::copy_n(model.density.data() + from, length, cropped.density.begin() + to);
      }
    }
  }
  model = std::move(cropped);
}

}  // namespace haptrial::bone
