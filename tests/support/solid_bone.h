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
  for (int k = 0; k < size; ++k) {
    for (int j = 0; j < size; ++j) {
      for (int i = 0; i < size; ++i) {
        model.labels.push_back(inside(model.grid.centre(i, j, k)) ? 1 : 0);
      }
    }
  }
  return model;
}

/// Bone below z = 0, air above. An even size puts a face between voxels there.
inline bone::BoneModel flat_bone(int size, double spacing) {
  return solid_bone(size, spacing, [](const Eigen::Vector3d& p) { return p.z() < 0.0; });
}

}  // namespace haptrial::test
