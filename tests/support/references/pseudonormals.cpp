#include "tests/support/references/pseudonormals.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>

#include "core/base/error.h"
#include "core/geometry/mesh/mesh_edges.h"

namespace haptrial::geometry {
namespace {

Eigen::Vector3d unit_normal(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                            const Eigen::Vector3d& c) {
  const Eigen::Vector3d normal = (b - a).cross(c - a);
  const double length = normal.norm();
  return length > 0.0 ? Eigen::Vector3d(normal / length) : Eigen::Vector3d::Zero();
}

double angle_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

void check(const Mesh& mesh) {
  const auto count = static_cast<std::int32_t>(mesh.vertices.size());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    for (const std::int32_t corner : mesh.triangles[i]) {
      if (corner >= 0 && corner < count) {
        continue;
      }
      throw InputError(
          fmt::format("triangle {} names vertex {}; allowed: 0 to {}", i, corner, count - 1));
    }
  }
}

}  // namespace

Pseudonormals::Pseudonormals(const Mesh& mesh) : corners_(mesh.triangles) {
  check(mesh);
  of_face_.resize(mesh.triangles.size());
  of_edge_.assign(mesh.triangles.size(),
                  {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()});
  of_corner_.assign(mesh.vertices.size(), Eigen::Vector3d::Zero());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto corner = [&](int k) { return mesh.vertices[mesh.triangles[i][k % 3]]; };
    of_face_[i] = unit_normal(corner(0), corner(1), corner(2));
    for (int k = 0; k < 3; ++k) {
      const double angle = angle_between(corner(k + 1) - corner(k), corner(k + 2) - corner(k));
      of_corner_[mesh.triangles[i][k]] += angle * of_face_[i];
    }
  }
  const EdgeTable edges(mesh);
  for (std::size_t edge = 0; edge < edges.size(); ++edge) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const Side side : edges.sides(edge)) {
      sum += of_face_[triangle_of(side)];
    }
    for (const Side side : edges.sides(edge)) {
      of_edge_[triangle_of(side)][side % 3] = sum;
    }
  }
}

const Eigen::Vector3d& Pseudonormals::at(const ClosestPoint& nearest) const {
  const int part = static_cast<int>(nearest.part);
  if (part == 0) {
    return of_face_[nearest.triangle];
  }
  if (part <= 3) {
    return of_edge_[nearest.triangle][part - 1];
  }
  return of_corner_[corners_[nearest.triangle][part - 4]];
}

double Pseudonormals::signed_distance(const Eigen::Vector3d& point,
                                      const ClosestPoint& nearest) const {
  const double distance = std::sqrt(nearest.distance_squared);
  if (nearest.triangle < 0) {
    return distance;
  }
  return (point - nearest.point).dot(at(nearest)) < 0.0 ? -distance : distance;
}

}  // namespace haptrial::geometry
