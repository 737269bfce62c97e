#pragma once

#include <functional>
#include <map>
#include <tuple>
#include <vector>

#include "core/base/random.h"
#include "core/bone/model/world.h"

namespace haptrial::test {}

namespace haptrial::bone::test {

using namespace haptrial::test;  // helpers of all tests, beside those of this folder

/// A grid of cubes of 0.5 mm with bone where `holds` says so; with densities above 0 drawn from a
/// stream where there is one.
inline BoneModel make_bone(std::array<std::int32_t, 3> size,
                           const std::function<bool(const Voxel&)>& holds,
                           RandomStream* densities = nullptr) {
  BoneModel model;
  model.name = "made for a test";
  model.grid = {size, {-0.01, 0.002, 0.03}, 0.5e-3};
  model.labels.assign(model.grid.count(), 0);
  model.structures = {{}, {.name = "bone"}, {.name = "nerve", .vital = true}};
  if (densities != nullptr) {
    model.density.assign(model.grid.count(), 0.0F);
  }
  for (int k = 0; k < size[2]; ++k) {
    for (int j = 0; j < size[1]; ++j) {
      for (int i = 0; i < size[0]; ++i) {
        const std::size_t at = model.grid.index(i, j, k);
        if (holds(Voxel(i, j, k))) {
          model.labels[at] = static_cast<std::uint8_t>(1 + (i + j + k) % 7 / 6);
          if (densities != nullptr) {
            model.density[at] = static_cast<float>(densities->uniform(0.05, 1.0));
          }
        }
      }
    }
  }
  return model;
}

inline BoneModel make_box(std::array<std::int32_t, 3> size) {
  return make_bone(size, [](const Voxel&) { return true; });
}

/// All voxels of a grid.
template <class F>
void for_each_voxel(const geometry::VoxelGrid& grid, F&& f) {
  geometry::visit_voxels(grid, [&](const Voxel& voxel, std::size_t) { f(voxel); });
}

inline std::int64_t voxels_in(const BoneVolume& volume) {
  std::int64_t count = 0;
  for_each_voxel(volume.grid(), [&](const Voxel& v) { count += volume.density(v) > 0.0F ? 1 : 0; });
  return count;
}

/// Voxels as keys of a set or map.
struct VoxelOrder {
  bool operator()(const Voxel& a, const Voxel& b) const {
    return std::tuple(a.z(), a.y(), a.x()) < std::tuple(b.z(), b.y(), b.x());
  }
};

/// The parts of a set by walking from voxel to voxel; the reference that Flood is held against.
inline std::vector<std::vector<Voxel>> walk_parts(const geometry::VoxelGrid& grid,
                                                  const std::function<bool(const Voxel&)>& holds) {
  std::vector<bool> seen(grid.count(), false);
  const auto fresh = [&](const Voxel& v) {
    for (int axis = 0; axis < 3; ++axis) {
      if (v[axis] < 0 || v[axis] >= grid.size[static_cast<std::size_t>(axis)]) {
        return false;
      }
    }
    return holds(v) && !seen[grid.index(v)];
  };
  std::vector<std::vector<Voxel>> parts;
  for_each_voxel(grid, [&](const Voxel& seed) {
    if (!fresh(seed)) {
      return;
    }
    parts.emplace_back(1, seed);
    seen[grid.index(seed)] = true;
    for (std::size_t next = 0; next < parts.back().size(); ++next) {
      for (int axis = 0; axis < 3; ++axis) {
        for (const int step : {-1, 1}) {
          const Voxel beside = parts.back()[next] + step * Voxel::Unit(axis);
          if (fresh(beside)) {
            seen[grid.index(beside)] = true;
            parts.back().push_back(beside);
          }
        }
      }
    }
  });
  return parts;
}

/// Lets the search and the servo thread's part take turns until nothing is left to do.
inline std::vector<WorldEvent> settle(BoneWorld& world) {
  std::vector<WorldEvent> events;
  for (int quiet = 0; quiet < 4; ++quiet) {
    world.search();
    for (int tick = 0; tick < 500; ++tick) {
      world.step();
      if (!world.events().empty()) {
        events.insert(events.end(), world.events().begin(), world.events().end());
        quiet = 0;
      }
    }
  }
  return events;
}

}  // namespace haptrial::bone::test
