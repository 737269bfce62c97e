#include "core/deformable/calibration/marker.h"

#include <Eigen/LU>
#include <algorithm>
#include <limits>

namespace haptrial::deformable {

using Eigen::Vector3d;

Marker marker_at(const geometry::TetMesh& body, const Vector3d& rest, const Vector3d& moved) {
  Marker found{{}, Eigen::Vector4d::Zero(), moved};
  double best = -std::numeric_limits<double>::infinity();
  for (const geometry::Tetrahedron& t : body.tetrahedra) {
    const Vector3d& first = body.vertices[static_cast<std::size_t>(t[0])];
    Eigen::Matrix3d edges;
    for (std::size_t i = 1; i < t.size(); ++i) {
      edges.col(static_cast<Eigen::Index>(i) - 1) =
          body.vertices[static_cast<std::size_t>(t[i])] - first;
    }
    const Vector3d w = edges.inverse() * (rest - first);
    const double inside = std::min(w.minCoeff(), 1.0 - w.sum());
    if (inside > best) {
      best = inside;
      found.vertices = t;
      found.weights << 1.0 - w.sum(), w;
    }
    if (best >= 0.0) {
      break;
    }
  }
  return found;
}

Vector3d place_of(const Marker& marker, std::span<const Vector3d> positions) {
  Vector3d place = Vector3d::Zero();
  for (std::size_t i = 0; i < marker.vertices.size(); ++i) {
    place += marker.weights[static_cast<Eigen::Index>(i)] *
             positions[static_cast<std::size_t>(marker.vertices[i])];
  }
  return place;
}

}  // namespace haptrial::deformable
