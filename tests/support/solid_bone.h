#pragma once

#include <utility>

#include "core/bone/model/bone_model.h"

namespace haptrial::test {

/// A cube of `size` voxels along each axis about the origin, with bone (label 1, density 1)
/// wherever `inside` says so of a voxel's centre.
template <class Inside>
bone::BoneModel solid_bone(int size, double spacing, Inside&& inside) {
  bone::BoneModel model;
  const double first = -0.5 * spacing * (size - 1);
  model.grid = {{size, size, size}, Eigen::Vector3d::Constant(first), spacing};
  model.structures = {{}, {"bone"}};
  model.labels.reserve(model.grid.count());
  geometry::visit_voxels(model.grid, [&](const Eigen::Vector3i& voxel, std::size_t) {
    model.labels.push_back(inside(model.grid.centre(voxel)) ? 1 : 0);
  });
  return model;
}

/// Bone below z = 0, air above. An even size puts a face between voxels there.
inline bone::BoneModel flat_bone(int size, double spacing) {
  return solid_bone(size, spacing, [](const Eigen::Vector3d& p) { return p.z() < 0.0; });
}

/// A block of bone, 40 x 40 x 30 voxels of 1 mm, with a nerve along x and a post as incus.
inline bone::BoneModel block_with_nerve() {
  bone::BoneModel model;
  model.name = "block";
  model.grid = {{40, 40, 30}, {0.0, 0.0, 0.0}, 1e-3};
  model.labels.assign(model.grid.count(), 1);
  for (int i = 0; i < 40; ++i) {
    model.labels[model.grid.index(i, 20, 16)] = 2;
  }
  model.labels[model.grid.index(20, 13, 12)] = 3;
  model.structures = {{},
                      {"bone", {0.9, 0.9, 0.8}, 1.0, false},
                      {"facial nerve", {1.0, 0.9, 0.2}, 0.5, true},
                      {"incus", {1.0, 0.5, 0.2}, 1.0, true}};
  return model;
}

}  // namespace haptrial::test
