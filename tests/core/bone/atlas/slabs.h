#pragma once

#include <cstdint>
#include <vector>

#include "core/bone/model/bone_model.h"

namespace haptrial::test {

/// A bone of one row of voxels of 1 mm, all spongy bone, which knows two structures.
inline bone::BoneModel bone_in_a_row(int length) {
  bone::BoneModel model;
  model.name = "row";
  model.grid = {{length, 1, 1}, Eigen::Vector3d::Zero(), 1e-3};
  model.labels.assign(static_cast<std::size_t>(length), 1);
  model.density.assign(static_cast<std::size_t>(length), 0.4F);  // spongy
  model.structures.resize(4);
  model.structures[1].name = bone::kPlainBone;
  model.structures[2].name = "facial nerve";
  model.structures[2].hardness = 0.25;
  model.structures[3].name = "incus";
  return model;
}

/// Labels of a row: a label from one voxel to before another, else nothing.
inline std::vector<std::uint8_t> slab(int length, int from, int to, std::uint8_t label = 2) {
  std::vector<std::uint8_t> labels(static_cast<std::size_t>(length), 0);
  for (int i = from; i < to; ++i) {
    labels[static_cast<std::size_t>(i)] = label;
  }
  return labels;
}

}  // namespace haptrial::test
