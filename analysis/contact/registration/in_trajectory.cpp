#include "analysis/contact/registration/in_trajectory.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace haptrial::evaluation {
namespace {

using geometry::Mesh;
using Normals = std::vector<Eigen::Vector3d>;

double angle_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

Normals corner_normals(const Mesh& mesh) {
  Normals normals(mesh.vertices.size(), Eigen::Vector3d::Zero());
  for (const auto& t : mesh.triangles) {
    for (std::size_t c = 0; c < 3; ++c) {
      const Eigen::Vector3d& at = mesh.vertices[static_cast<std::size_t>(t[c])];
      const Eigen::Vector3d a = mesh.vertices[static_cast<std::size_t>(t[(c + 1) % 3])] - at;
      const Eigen::Vector3d b = mesh.vertices[static_cast<std::size_t>(t[(c + 2) % 3])] - at;
      normals[static_cast<std::size_t>(t[c])] +=
          angle_between(a, b) * a.cross(b).stableNormalized();
    }
  }
  return normals;
}

Eigen::Vector3d interpolated(const Mesh& mesh, const Normals& normals,
                             const geometry::ClosestPoint& nearest) {
  const geometry::Triangle& t = mesh.triangles[static_cast<std::size_t>(nearest.triangle)];
  const auto corner = [&](std::size_t c) -> const Eigen::Vector3d& {
    return mesh.vertices[static_cast<std::size_t>(t[c])];
  };
  const Eigen::Vector3d face = (corner(1) - corner(0)).cross(corner(2) - corner(0));
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t c = 0; c < 3; ++c) {
    const Eigen::Vector3d across =
        (corner((c + 1) % 3) - nearest.point).cross(corner((c + 2) % 3) - nearest.point);
    const double weight = std::max(0.0, across.dot(face));
    sum += weight * normals[static_cast<std::size_t>(t[c])].stableNormalized();
  }
  return sum.norm() > 0.0 ? Eigen::Vector3d(sum.stableNormalized())
                          : Eigen::Vector3d(face.stableNormalized());
}

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

std::vector<Eigen::Vector3d> path_normals(const geometry::Bvh& bvh, const Mesh& mesh,
                                          std::span<const Eigen::Vector3d> path, double smoothing) {
  if (mesh.triangles.empty() || !(smoothing >= 0.0 && std::isfinite(smoothing))) {
    throw std::invalid_argument("path normals need a mesh with triangles and a smoothing >= 0");
  }
  const Normals corners = corner_normals(mesh);
  Normals normals;
  for (const auto& p : path) {
    if (!p.allFinite()) {
      throw std::invalid_argument("path must be finite");
    }
    normals.push_back(interpolated(mesh, corners, bvh.closest(p)));
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
