#include "core/bone/model/thickness.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "core/bone/model/voxel_walk.h"

namespace haptrial::bone {
namespace {

constexpr int kMostReach = 4;

/// Binomial weights: a Gaussian in integers, whose sums do not depend on rounding.
std::array<double, 2 * kMostReach + 1> weights(int reach) {
  std::array<double, 2 * kMostReach + 1> w{};
  w[0] = 1.0;
  for (int row = 1; row <= 2 * reach; ++row) {
    for (int i = row; i > 0; --i) {
      w[static_cast<std::size_t>(i)] += w[static_cast<std::size_t>(i - 1)];
    }
  }
  return w;
}

double bone_at(const BoneVolume& volume, const Voxel& voxel, const ThicknessParameters& p) {
  const std::int32_t address = volume.address(voxel);
  return p.bone[volume.label(address)] ? static_cast<double>(volume.density(address)) : 0.0;
}

Eigen::Vector3d centre_of(const BoneVolume& volume, const Voxel& voxel) {
  return volume.grid().centre(voxel);
}

/// How far bone reaches from a point along a unit direction, at most `limit` [m].
double reach_of(const BoneVolume& volume, const Eigen::Vector3d& from,
                const Eigen::Vector3d& direction, double limit, const ThicknessParameters& p) {
  double end = 0.0;
  walk_voxels(volume.grid(), from, from + limit * direction,
              [&](const Voxel& voxel, double, double out) {
                const bool in_bone = bone_at(volume, voxel, p) > 0.0;
                end = in_bone ? out : end;
                return in_bone;
              });
  return limit * end;
}

void require(const ThicknessParameters& p) {
  if (!(p.limit > 0.0 && std::isfinite(p.limit)) || p.reach < 1 || p.reach > kMostReach) {
    throw std::invalid_argument("thickness: the limit must be above 0 m, the reach from 1 to 4");
  }
}

}  // namespace

std::optional<Eigen::Vector3d> outward_normal(const BoneVolume& volume, const Voxel& voxel,
                                              const ThicknessParameters& parameters) {
  require(parameters);
  const int reach = parameters.reach;
  const auto weight = weights(reach);
  const auto at = [&](int offset) { return weight[static_cast<std::size_t>(offset + reach)]; };
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
  double all = 0.0;
  for (int k = -reach; k <= reach; ++k) {
    for (int j = -reach; j <= reach; ++j) {
      for (int i = -reach; i <= reach; ++i) {
        const double w = at(i) * at(j) * at(k);
        const double density = bone_at(volume, voxel + Voxel(i, j, k), parameters);
        gradient += w * density * Eigen::Vector3d(i, j, k);
        all += w * std::abs(i);
      }
    }
  }
  constexpr double kLeast = 0.02;  // of the gradient at the face of a half space
  const double size = gradient.norm();
  if (!(size > kLeast * 0.5 * all)) {
    return std::nullopt;
  }
  return Eigen::Vector3d(-gradient / size);
}

std::optional<double> thickness_at(const BoneVolume& volume, const Voxel& voxel,
                                   const ThicknessParameters& parameters) {
  if (!(bone_at(volume, voxel, parameters) > 0.0)) {
    return std::nullopt;
  }
  const auto normal = outward_normal(volume, voxel, parameters);
  if (!normal) {
    return std::nullopt;
  }
  const Eigen::Vector3d centre = centre_of(volume, voxel);
  const double to_entry = reach_of(volume, centre, *normal, parameters.limit, parameters);
  const double to_exit = reach_of(volume, centre, -*normal, parameters.limit, parameters);
  return std::min(parameters.limit, to_entry + to_exit);
}

std::optional<double> mean_thickness(const BoneVolume& volume, std::span<const Voxel> voxels,
                                     const ThicknessParameters& parameters, int most) {
  if (most < 1) {
    throw std::invalid_argument("thickness: at least one voxel must be visited");
  }
  const std::size_t visits = std::min(voxels.size(), static_cast<std::size_t>(most));
  double sum = 0.0;
  int count = 0;
  for (std::size_t visit = 0; visit < visits; ++visit) {
    const Voxel& voxel = voxels[visit * voxels.size() / visits];
    if (const auto thickness = thickness_at(volume, voxel, parameters)) {
      sum += *thickness;
      ++count;
    }
  }
  return count == 0 ? std::nullopt : std::optional(sum / count);
}

void surface_voxels_within(const BoneVolume& volume, const Eigen::Vector3d& centre, double radius,
                           std::vector<Voxel>& voxels) {
  voxels.clear();
  const geometry::VoxelGrid& grid = volume.grid();
  const Eigen::Array3d middle = (centre - grid.origin).array() / grid.spacing;
  const double extent = radius / grid.spacing;
  if (!(middle.isFinite().all() && extent >= 0.0 && std::isfinite(extent))) {
    return;
  }
  Voxel low;
  Voxel high;
  for (int axis = 0; axis < 3; ++axis) {
    const double last = grid.size[static_cast<std::size_t>(axis)] - 1;
    low[axis] = static_cast<int>(std::clamp(std::ceil(middle[axis] - extent), 0.0, last + 1.0));
    high[axis] = static_cast<int>(std::clamp(std::floor(middle[axis] + extent), -1.0, last));
  }
  const auto empty = [&](const Voxel& voxel) { return !(volume.density(voxel) > 0.0F); };
  for (int k = low.z(); k <= high.z(); ++k) {
    for (int j = low.y(); j <= high.y(); ++j) {
      for (int i = low.x(); i <= high.x(); ++i) {
        const Voxel voxel(i, j, k);
        if (empty(voxel) || (centre_of(volume, voxel) - centre).squaredNorm() > radius * radius) {
          continue;
        }
        if (empty({i - 1, j, k}) || empty({i + 1, j, k}) || empty({i, j - 1, k}) ||
            empty({i, j + 1, k}) || empty({i, j, k - 1}) || empty({i, j, k + 1})) {
          voxels.push_back(voxel);
        }
      }
    }
  }
}

}  // namespace haptrial::bone
