#include "core/contact/shading.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace haptrial::contact {
namespace {

using Eigen::Vector3d;

/// The corner of a triangle: 3 triangle + k.
using Corner = std::int32_t;

double angle_at(const geometry::Mesh& mesh, Corner corner) {
  const geometry::Triangle& t = mesh.triangles[corner / 3];
  const int k = corner % 3;
  const Vector3d a = mesh.vertices[t[(k + 1) % 3]] - mesh.vertices[t[k]];
  const Vector3d b = mesh.vertices[t[(k + 2) % 3]] - mesh.vertices[t[k]];
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

/// The corners at each vertex, one vertex after the other.
struct Fans {
  std::vector<std::int32_t> begin;  // of each vertex, and the end
  std::vector<Corner> corners;

  explicit Fans(const geometry::Mesh& mesh) : begin(mesh.vertices.size() + 1, 0) {
    for (const geometry::Triangle& t : mesh.triangles) {
      for (const std::int32_t v : t) {
        ++begin[v + 1];
      }
    }
    for (std::size_t v = 1; v < begin.size(); ++v) {
      begin[v] += begin[v - 1];
    }
    corners.resize(3 * mesh.triangles.size());
    std::vector<std::int32_t> next(begin.begin(), begin.end() - 1);
    for (Corner c = 0; c < static_cast<Corner>(corners.size()); ++c) {
      corners[next[mesh.triangles[c / 3][c % 3]]++] = c;
    }
  }
};

bool share_edge_at(const geometry::Mesh& mesh, Corner a, Corner b) {
  const geometry::Triangle &s = mesh.triangles[a / 3], &t = mesh.triangles[b / 3];
  for (const int i : {1, 2}) {
    for (const int j : {1, 2}) {
      if (s[(a % 3 + i) % 3] == t[(b % 3 + j) % 3]) {
        return true;
      }
    }
  }
  return false;
}

}  // namespace

Shading::Shading(const geometry::Mesh& mesh, const ContactSurface& surface, double crease_angle)
    : surface_(&surface), corners_(mesh.triangles.size()) {
  const Fans fans(mesh);
  const double least = std::cos(crease_angle);
  const auto face = [&](Corner c) -> const Vector3d& {
    return surface.normal(surface.slot(c / 3));
  };
  std::vector<Corner> group;
  for (std::size_t v = 0; v + 1 < fans.begin.size(); ++v) {
    const auto first = fans.corners.begin() + fans.begin[v];
    const auto last = fans.corners.begin() + fans.begin[v + 1];
    for (auto own = first; own != last; ++own) {
      // The group grows from triangle to triangle over smooth edges, as far as none turns away from
      // the own normal.
      group.assign(1, *own);
      Vector3d sum = angle_at(mesh, *own) * face(*own);
      for (std::size_t i = 0; i < group.size(); ++i) {
        for (auto other = first; other != last; ++other) {
          if (face(*other).dot(face(group[i])) >= least && face(*other).dot(face(*own)) > 0.0 &&
              share_edge_at(mesh, group[i], *other) &&
              std::find(group.begin(), group.end(), *other) == group.end()) {
            group.push_back(*other);
            sum += angle_at(mesh, *other) * face(*other);
          }
        }
      }
      corners_[*own / 3][*own % 3] = sum.stableNormalized();
    }
  }
}

Vector3d Shading::normal(std::int32_t triangle, const Vector3d& at,
                         const Vector3d& normal) const noexcept {
  const geometry::Corners& c = surface_->corners(surface_->slot(triangle));
  const Vector3d across = (c[1] - c[0]).cross(c[2] - c[0]);
  const double square = across.squaredNorm();
  if (!(square > 0.0)) {
    return normal;
  }
  std::array<double, 3> weight;
  double sum = 0.0;
  for (int k = 0; k < 3; ++k) {
    const Vector3d &a = c[(k + 1) % 3], &b = c[(k + 2) % 3];
    weight[k] = std::max(0.0, across.dot((a - at).cross(b - at)) / square);
    sum += weight[k];
  }
  Vector3d shaded = Vector3d::Zero();
  for (int k = 0; k < 3; ++k) {
    shaded += weight[k] / sum * corners_[triangle][k];
  }
  if (across.dot(normal) < 0.0) {
    shaded = -shaded;
  }
  const double length = shaded.norm();
  return shaded.dot(normal) > 0.0 ? Vector3d(shaded / length) : normal;
}

}  // namespace haptrial::contact
