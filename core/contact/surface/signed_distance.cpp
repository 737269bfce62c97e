#include "core/contact/surface/signed_distance.h"

#include <Eigen/Geometry>
#include <cmath>
#include <map>
#include <utility>

namespace haptrial::contact {

using Eigen::Vector3d;
using geometry::TrianglePart;

SignedDistance::SignedDistance(const geometry::Mesh& mesh, const ContactSurface& surface)
    : surface_(&surface),
      triangles_(mesh.triangles),
      corner_normals_(mesh.vertices.size(), Vector3d::Zero()),
      edge_normals_(mesh.triangles.size()) {
  std::map<std::pair<std::int32_t, std::int32_t>, Vector3d> edges;
  const auto edge_of = [&](std::size_t t, int k) {
    return std::pair(std::minmax(triangles_[t][k], triangles_[t][(k + 1) % 3]));
  };
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    const Vector3d& n = surface.normal(surface.slot(static_cast<std::int32_t>(t)));
    for (int k = 0; k < 3; ++k) {
      const Vector3d& at = mesh.vertices[triangles_[t][k]];
      const Vector3d a = mesh.vertices[triangles_[t][(k + 1) % 3]] - at;
      const Vector3d b = mesh.vertices[triangles_[t][(k + 2) % 3]] - at;
      corner_normals_[triangles_[t][k]] += std::atan2(a.cross(b).norm(), a.dot(b)) * n;
      edges.try_emplace(edge_of(t, k), Vector3d::Zero()).first->second += n;
    }
  }
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    for (int k = 0; k < 3; ++k) {
      edge_normals_[t][k] = edges.at(edge_of(t, k));
    }
  }
}

SurfacePoint SignedDistance::operator()(const Vector3d& point, std::int32_t hint) const noexcept {
  const geometry::ClosestPoint nearest = surface_->bvh().closest(point, hint);
  SurfacePoint answer;
  answer.triangle = nearest.triangle;
  if (nearest.triangle < 0) {
    answer.distance = std::numeric_limits<double>::infinity();
    return answer;
  }
  answer.point = nearest.point;
  const auto part = static_cast<int>(nearest.part);
  const Vector3d& face = surface_->normal(surface_->slot(nearest.triangle));
  const Vector3d out = nearest.part == TrianglePart::kFace ? face
                       : nearest.part <= TrianglePart::kEdge2
                           ? edge_normals_[nearest.triangle][part - 1]
                           : corner_normals_[triangles_[nearest.triangle][part - 4]];
  const Vector3d away = point - nearest.point;
  const double side = away.dot(out) < 0.0 ? -1.0 : 1.0;
  const double distance = std::sqrt(nearest.distance_squared);
  answer.distance = side * distance;
  answer.normal = nearest.part == TrianglePart::kFace || !(distance > 0.0)
                      ? face
                      : Vector3d(side / distance * away);
  return answer;
}

SurfacePoint SignedDistance::of_plane(const Vector3d& point, std::int32_t triangle) const noexcept {
  const std::int32_t slot = surface_->slot(triangle);
  const Vector3d& normal = surface_->normal(slot);
  const double height = normal.dot(point - surface_->corners(slot)[0]);
  return {height, point - height * normal, normal, triangle};
}

}  // namespace haptrial::contact
