#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/bone/model/bone_volume.h"

namespace haptrial::bone {

/// Visits every voxel of a grid that a segment passes through, in order, each once; voxels that it
/// only touches at an edge or corner may be left out. Any thread; does not allocate.
/// @param from, to  ends in the grid's frame [m]; nothing is visited unless both are finite
/// @param visit     bool(const Voxel&, double in, double out): the part of the segment in the
///                  voxel, as fractions of its length; false ends the walk
/// Source: Amanatides and Woo 1987.
template <class Visit>
void walk_voxels(const geometry::VoxelGrid& grid, const Eigen::Vector3d& from,
                 const Eigen::Vector3d& to, Visit&& visit) {
  // The start is in units of voxels, with voxel i from i to i + 1.
  const Eigen::Array3d start = ((from - grid.origin) / grid.spacing).array() + 0.5;
  const Eigen::Array3d along = (to - from).array() / grid.spacing;
  if (!(start.isFinite().all() && along.isFinite().all())) {
    return;
  }
  double in = 0.0;
  double end = 1.0;
  for (int axis = 0; axis < 3; ++axis) {
    const double size = grid.size[static_cast<std::size_t>(axis)];
    if (along[axis] == 0.0) {
      if (!(start[axis] >= 0.0 && start[axis] < size)) {
        return;
      }
      continue;
    }
    const double a = (0.0 - start[axis]) / along[axis];
    const double b = (size - start[axis]) / along[axis];
    in = std::max(in, std::min(a, b));
    end = std::min(end, std::max(a, b));
  }
  if (in > end) {
    return;
  }
  Voxel voxel;
  Voxel step;
  Eigen::Array3d next;   // where the segment leaves the voxel, by axis
  Eigen::Array3d width;  // of a voxel
  for (int axis = 0; axis < 3; ++axis) {
    const double at = start[axis] + in * along[axis];
    const int last = grid.size[static_cast<std::size_t>(axis)] - 1;
    voxel[axis] = std::clamp(static_cast<int>(std::floor(at)), 0, last);
    step[axis] = along[axis] > 0.0 ? 1 : -1;
    const bool still = along[axis] == 0.0;
    const double face = voxel[axis] + (along[axis] > 0.0 ? 1.0 : 0.0);
    next[axis] =
        still ? std::numeric_limits<double>::infinity() : (face - start[axis]) / along[axis];
    width[axis] = still ? 0.0 : std::abs(1.0 / along[axis]);
  }
  while (true) {
    Eigen::Index axis = 0;
    const double out = std::min(next.minCoeff(&axis), end);
    if (!visit(static_cast<const Voxel&>(voxel), in, std::max(in, out)) || out >= end) {
      return;
    }
    voxel[axis] += step[axis];
    if (voxel[axis] < 0 || voxel[axis] >= grid.size[static_cast<std::size_t>(axis)]) {
      return;
    }
    in = std::max(in, out);
    next[axis] += width[axis];
  }
}

}  // namespace haptrial::bone
