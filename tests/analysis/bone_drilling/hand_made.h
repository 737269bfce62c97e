#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "analysis/bone_drilling/metrics/procedure.h"
#include "core/base/random.h"

namespace haptrial::test {

/// A block of bone of `size` voxels, spacing 1 mm, voxel (0, 0, 0) centred on the origin.
inline bone::BoneModel block(int x, int y, int z) {
  bone::BoneModel model;
  model.name = "block";
  model.grid = {{x, y, z}, Eigen::Vector3d::Zero(), 1e-3};
  model.structures = {{}, {"bone"}};
  model.labels.assign(model.grid.count(), 1);
  return model;
}

/// Gives a voxel a label; 0 takes it away.
inline void mark(bone::BoneModel& model, const bone::Voxel& v, std::uint8_t label) {
  model.labels[model.grid.index(v)] = label;
}

/// One tool, a burr of 2 mm; a tick a millisecond.
inline analysis::drilling::Procedure procedure_on(bone::BoneModel model) {
  analysis::drilling::Procedure p;
  p.participant = "P01";
  p.bone = std::make_shared<const bone::BoneModel>(std::move(model));
  p.tools = {{"burr", 1e-3}};
  return p;
}

inline analysis::drilling::ToolTick drilling_tick(std::uint64_t sequence,
                                                  const Eigen::Vector3d& position,
                                                  double force = 0.5) {
  analysis::drilling::ToolTick tick;
  tick.sequence = sequence;
  tick.position = position;
  tick.force = force;
  tick.power = true;
  tick.in_bone = true;
  return tick;
}

/// Drilling with the burr's centre in each voxel, one after the other, which removes it.
inline void remove_in_turn(analysis::drilling::Procedure& p, const std::vector<bone::Voxel>& voxels,
                           double force = 0.5, double speed = 0.02) {
  for (const bone::Voxel& v : voxels) {
    const std::uint64_t sequence = p.ticks.empty() ? 0 : p.ticks.back().sequence + 1;
    const Eigen::Vector3d centre = p.bone->grid.centre(v);
    p.ticks.push_back(drilling_tick(sequence, p.pose_WB * centre, force));
    const std::uint8_t label = p.bone->labels[p.bone->grid.index(v)];
    p.removals.push_back({sequence, v, label, force, speed});
  }
}

inline bone::Voxel any_voxel(RandomStream& random, const geometry::VoxelGrid& grid) {
  bone::Voxel v;
  for (int axis = 0; axis < 3; ++axis) {
    v[axis] = static_cast<int>(
        random.below(static_cast<std::uint64_t>(grid.size[static_cast<std::size_t>(axis)])));
  }
  return v;
}

}  // namespace haptrial::test
