#include "analysis/contact/registration/surface_point.h"

#include <Eigen/Geometry>
#include <cmath>

namespace haptrial::evaluation {

SurfacePoint nearest_surface(const geometry::Bvh& bvh, const geometry::Mesh& mesh,
                             const Eigen::Vector3d& p) {
  const geometry::ClosestPoint nearest = bvh.closest(p);
  const geometry::Triangle& t = mesh.triangles[static_cast<std::size_t>(nearest.triangle)];
  const auto corner = [&](int c) -> const Eigen::Vector3d& {
    return mesh.vertices[static_cast<std::size_t>(t[static_cast<std::size_t>(c)])];
  };
  const Eigen::Vector3d face =
      (corner(1) - corner(0)).cross(corner(2) - corner(0)).stableNormalized();
  const Eigen::Vector3d away = p - nearest.point;
  const double distance = std::sqrt(nearest.distance_squared);
  const double sign = away.dot(face) < 0.0 ? -1.0 : 1.0;
  // Close to the surface the way to it has no direction of its own.
  const double rounding = 1e-12 * (p.norm() + nearest.point.norm());
  const bool on_face = nearest.part == geometry::TrianglePart::kFace || distance <= rounding;
  const Eigen::Vector3d normal = on_face ? face : Eigen::Vector3d(sign / distance * away);
  return {nearest.point, normal, sign * distance};
}

}  // namespace haptrial::evaluation
