#include "core/contact/signed_distance.h"

#include <Eigen/Geometry>
#include <cmath>

#include "core/geometry/mesh/mesh_edges.h"

namespace haptrial::contact {

using Eigen::Vector3d;
using geometry::TrianglePart;

SignedDistance::SignedDistance(const geometry::Mesh& mesh, const ContactSurface& surface)
    : surface_(&surface),
      triangles_(mesh.triangles),
      corner_normals_(mesh.vertices.size(), Vector3d::Zero()),
      edge_normals_(mesh.triangles.size()) {
  const auto normal = [&](std::size_t t) -> const Vector3d& {
    return surface.normal(surface.slot(static_cast<std::int32_t>(t)));
  };
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const Vector3d& at = mesh.vertices[triangles_[t][k]];
      const Vector3d a = mesh.vertices[triangles_[t][(k + 1) % 3]] - at;
      const Vector3d b = mesh.vertices[triangles_[t][(k + 2) % 3]] - at;
      corner_normals_[triangles_[t][k]] += std::atan2(a.cross(b).norm(), a.dot(b)) * normal(t);
    }
  }
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    for (int k = 0; k < 3; ++k) {  // what stays of triangles that repeat a corner
      edge_normals_[t][k] =
          corner_normals_[triangles_[t][k]] + corner_normals_[triangles_[t][(k + 1) % 3]];
    }
  }
  const geometry::EdgeTable edges(mesh);
  for (std::size_t e = 0; e < edges.size(); ++e) {
    Vector3d sum = Vector3d::Zero();
    for (const geometry::Side side : edges.sides(e)) {
      sum += normal(geometry::triangle_of(side));
    }
    for (const geometry::Side side : edges.sides(e)) {
      edge_normals_[geometry::triangle_of(side)][side % 3] = sum;
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
