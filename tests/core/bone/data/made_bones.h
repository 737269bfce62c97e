#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/bone/data/anatomy.h"
#include "core/bone/model/bone_model.h"

namespace haptrial::test {

/// Centres of all voxels with a label [mm].
inline std::vector<Eigen::Vector3d> places_of(const bone::BoneModel& model, bone::Anatomy label) {
  std::vector<Eigen::Vector3d> places;
  const geometry::VoxelGrid& grid = model.grid;
  geometry::visit_voxels(grid, [&](const Eigen::Vector3i& voxel, std::size_t at) {
    if (model.labels[at] == static_cast<std::uint8_t>(label)) {
      places.push_back(1e3 * grid.centre(voxel));
    }
  });
  return places;
}

/// The smallest distance between voxels of two structures, by trying all [mm].
inline double gap_between(const std::vector<Eigen::Vector3d>& a,
                          const std::vector<Eigen::Vector3d>& b) {
  double best = 1e18;
  for (const Eigen::Vector3d& p : a) {
    for (const Eigen::Vector3d& q : b) {
      best = std::min(best, (p - q).squaredNorm());
    }
  }
  return std::sqrt(best);
}

inline Eigen::Vector3d middle_of(const std::vector<Eigen::Vector3d>& places) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& p : places) {
    sum += p;
  }
  return sum / static_cast<double>(places.size());
}

}  // namespace haptrial::test
