#include "core/bone/data/procedural_bone.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/base/parallel.h"
#include "core/bone/data/anatomy.h"

namespace haptrial::bone {

BoneModel fill(const MadeGrid& made,
               const std::function<EarAnatomy::Material(const Point&)>& material,
               const geometry::WorkReport& report) {
  BoneModel model;
  model.name = made.name;
  model.structures = known_structures();
  geometry::VoxelGrid& grid = model.grid;
  grid.spacing = made.spacing;
  const Point size = 1e-3 * made.scale * (made.high - made.low);
  for (int axis = 0; axis < 3; ++axis) {
    grid.size[static_cast<std::size_t>(axis)] =
        static_cast<std::int32_t>(std::ceil(size[axis] / grid.spacing));
    grid.origin[axis] = 1e-3 * made.scale * made.low[axis] + 0.5 * grid.spacing;
  }
  model.labels.assign(grid.count(), 0);
  model.density.assign(grid.count(), 0.0F);
  const int threads = threads_or_all(made.threads);
  for (std::int32_t k = 0; k < grid.size[2]; ++k) {
    parallel_for(static_cast<std::size_t>(grid.size[1]), threads, [&](std::size_t row) {
      const auto j = static_cast<std::int32_t>(row);
      for (std::int32_t i = 0; i < grid.size[0]; ++i) {
        const Point p = grid.centre(i, j, k) * (1e3 / made.scale);
        const EarAnatomy::Material found = material(p);
        if (found.label == Anatomy::kNothing) {
          continue;
        }
        const std::size_t index = grid.index(i, j, k);
        model.labels[index] = static_cast<std::uint8_t>(found.label);
        const double level = std::clamp(std::floor(255.0 * found.density + 0.5), 1.0, 255.0);
        model.density[index] = static_cast<float>(level) / 255.0F;
      }
    });
    geometry::report_share(report, (k + 1.0) / grid.size[2]);
  }
  return model;
}

}  // namespace haptrial::bone
