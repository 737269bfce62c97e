#include "analysis/contact/evaluation/in_trajectory.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace haptrial::evaluation {
namespace {

using Normals = std::vector<Eigen::Vector3d>;

Normals averaged(const Normals& normals, std::span<const Eigen::Vector3d> path, double smoothing) {
  std::vector<double> length(path.size(), 0.0);
  for (std::size_t i = 1; i < path.size(); ++i) {
    length[i] = length[i - 1] + (path[i] - path[i - 1]).norm();
  }
  Normals result;
  std::size_t first = 0;
  for (std::size_t i = 0; i < path.size(); ++i) {
    while (length[i] - length[first] > 4.0 * smoothing) {
      ++first;
    }
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (std::size_t j = first; j < path.size() && length[j] - length[i] <= 4.0 * smoothing; ++j) {
      const double u = (length[j] - length[i]) / smoothing;
      sum += std::exp(-0.5 * u * u) * normals[j];
    }
    result.push_back(sum.norm() > 0.0 ? Eigen::Vector3d(sum.normalized()) : normals[i]);
  }
  return result;
}

}  // namespace

std::vector<Eigen::Vector3d> path_normals(const contact::ContactSurface& surface,
                                          const contact::Shading& shading,
                                          std::span<const Eigen::Vector3d> path, double smoothing) {
  if (surface.triangles() == 0 || !(smoothing >= 0.0 && std::isfinite(smoothing))) {
    throw std::invalid_argument("path normals need a mesh with triangles and a smoothing >= 0");
  }
  Normals normals;
  for (const auto& p : path) {
    if (!p.allFinite()) {
      throw std::invalid_argument("path must be finite");
    }
    const geometry::ClosestPoint nearest = surface.bvh().closest(p);
    normals.push_back(shading.normal(nearest.triangle, nearest.point,
                                     surface.normal(surface.slot(nearest.triangle))));
  }
  return smoothing > 0.0 ? averaged(normals, path, smoothing) : normals;
}

std::vector<Eigen::Vector3d> in_trajectory(std::span<const Eigen::Vector3d> out,
                                           std::span<const Eigen::Vector3d> force,
                                           std::span<const Eigen::Vector3d> normals,
                                           double stiffness) {
  if (out.size() != force.size() || out.size() != normals.size()) {
    throw std::invalid_argument("contacts, forces and normals must be equally many");
  }
  if (!(stiffness > 0.0 && std::isfinite(stiffness))) {
    throw std::invalid_argument("stiffness must be above 0 and finite");
  }
  std::vector<Eigen::Vector3d> in;
  in.reserve(out.size());
  for (std::size_t i = 0; i < out.size(); ++i) {
    in.emplace_back(out[i] - std::max(0.0, force[i].dot(normals[i])) / stiffness * normals[i]);
  }
  return in;
}

}  // namespace haptrial::evaluation
