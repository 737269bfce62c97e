#include "core/geometry/volume/voxel_grid.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/base/error.h"

namespace haptrial::geometry {

VoxelGrid make_grid(const Eigen::AlignedBox3d& box, int resolution, int margin) {
  constexpr int kMaxResolution = 20000;
  constexpr double kLeastSpacing = 1e-12;  // of the farthest coordinate: doubles tell 1e-16 apart
  if (resolution < 1 || resolution > kMaxResolution) {
    throw InputError(
        fmt::format("the resolution is {} voxels along the longest axis; allowed: 1 to {}",
                    resolution, kMaxResolution));
  }
  if (margin < 0 || margin > kMaxResolution) {
    throw InputError(
        fmt::format("the margin is {} voxels; allowed: 0 to {}", margin, kMaxResolution));
  }
  const Eigen::Vector3d sides = box.isEmpty() ? Eigen::Vector3d::Zero().eval() : box.sizes();
  if (!sides.allFinite() || !(sides.maxCoeff() > 0.0)) {
    throw InputError("the mesh has no extent, so no grid can cover it");
  }
  VoxelGrid grid;
  grid.spacing = sides.maxCoeff() / resolution;
  const double farthest = box.min().cwiseAbs().cwiseMax(box.max().cwiseAbs()).maxCoeff();
  if (!(grid.spacing > kLeastSpacing * farthest)) {
    throw InputError(fmt::format(
        "voxels of {:.3g} m are too small {:.3g} m away from the origin; allowed: {:.3g} m or more",
        grid.spacing, farthest, kLeastSpacing * farthest));
  }
  for (int axis = 0; axis < 3; ++axis) {
    // A side that is a whole number of voxels stays so in spite of rounding.
    const double voxels = std::ceil(sides[axis] / grid.spacing * (1.0 - 1e-12));
    const auto covering = std::max(1, static_cast<int>(voxels));
    grid.size[axis] = covering + 2 * margin;
    grid.origin[axis] = box.center()[axis] - 0.5 * (grid.size[axis] - 1) * grid.spacing;
  }
  return grid;
}

}  // namespace haptrial::geometry
