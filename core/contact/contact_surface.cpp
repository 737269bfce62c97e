#include "core/contact/contact_surface.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "core/geometry/bvh/bvh_data.h"

namespace haptrial::contact {

ContactSurface::ContactSurface(const geometry::Mesh& mesh, int threads)
    : bvh_(mesh, {.threads = threads}) {
  const geometry::BvhData& data = bvh_.data();
  corners_ = data.corners.begin();
  ids_ = data.ids.begin();
  slots_ = data.slots.begin();
  double area = 0.0;
  for (const geometry::Triangle& triangle : mesh.triangles) {
    const Eigen::Vector3d& a = mesh.vertices[triangle[0]];
    for (const std::int32_t corner : triangle) {
      magnitude_ = std::max(magnitude_, mesh.vertices[corner].cwiseAbs().maxCoeff());
    }
    area +=
        (mesh.vertices[triangle[1]] - a).cross(mesh.vertices[triangle[2]] - a).stableNorm() / 2.0;
  }
  const auto count = static_cast<double>(std::max<std::size_t>(mesh.triangles.size(), 1));
  typical_edge_ = std::sqrt(2.0 * area / count);
  find_normals(mesh);
}

void ContactSurface::find_normals(const geometry::Mesh& mesh) {
  const std::vector<Eigen::Vector3d> normals = triangle_normals(mesh, magnitude_);
  normals_.assign(bvh_.data().ids.size(), Eigen::Vector3d::Zero());
  for (std::size_t slot = 0; slot < normals_.size(); ++slot) {
    if (ids_[slot] >= 0) {
      normals_[slot] = normals[ids_[slot]];
    }
  }
}

namespace {

using Eigen::Vector3d;

/// The longest edge of a triangle and what its third corner says.
struct Shape {
  int start{0};      // the longest edge runs from this corner to the next
  Vector3d along;    // its direction, a unit vector; zero if the corners coincide
  Vector3d upwards;  // from the edge to the third corner, square to the edge [m]
};

Shape shape_of(const geometry::Mesh& mesh, const geometry::Triangle& triangle) {
  Shape shape;
  double longest = 0.0;
  for (int k = 0; k < 3; ++k) {
    const double length =
        (mesh.vertices[triangle[(k + 1) % 3]] - mesh.vertices[triangle[k]]).stableNorm();
    if (length > longest) {
      longest = length;
      shape.start = k;
    }
  }
  const Vector3d& start = mesh.vertices[triangle[shape.start]];
  shape.along = (mesh.vertices[triangle[(shape.start + 1) % 3]] - start).stableNormalized();
  shape.upwards = mesh.vertices[triangle[(shape.start + 2) % 3]] - start;
  for (int twice = 0; twice < 2; ++twice) {
    shape.upwards -= shape.along * shape.along.dot(shape.upwards);
  }
  if (longest == 0.0) {
    shape.along.setZero();
  }
  return shape;
}

using Edge = std::pair<std::int32_t, std::int32_t>;

Edge longest_edge(const geometry::Triangle& triangle, const Shape& shape) {
  return std::minmax({triangle[shape.start], triangle[(shape.start + 1) % 3]});
}

/// Gives thin triangles the normals of their neighbours, those of chains one after the other.
class ThinTriangles {
 public:
  ThinTriangles(const geometry::Mesh& mesh, std::vector<Vector3d>& normals,
                std::vector<std::int32_t> thin)
      : mesh_(mesh), normals_(normals), open_(std::move(thin)) {
    for (const std::int32_t t : open_) {
      beside_.try_emplace(longest_edge(mesh.triangles[t], shape_of(mesh, mesh.triangles[t])));
    }
    for (std::int32_t t = 0; t < static_cast<std::int32_t>(mesh.triangles.size()); ++t) {
      for (int k = 0; k < 3; ++k) {
        const Edge edge = std::minmax({mesh.triangles[t][k], mesh.triangles[t][(k + 1) % 3]});
        const auto found = beside_.find(edge);
        if (found != beside_.end()) {
          found->second.push_back(t);
        }
      }
    }
  }

  void fill() {
    std::size_t before = open_.size() + 1;
    while (open_.size() < before) {
      before = open_.size();
      std::erase_if(open_, [&](std::int32_t t) { return take_from_neighbour(t); });
    }
    for (const std::int32_t t : open_) {
      const Shape shape = shape_of(mesh_, mesh_.triangles[t]);
      normals_[t] = shape.along.isZero(0.0) ? Vector3d::Zero() : shape.along.unitOrthogonal();
    }
  }

 private:
  bool take_from_neighbour(std::int32_t t) {
    const Shape shape = shape_of(mesh_, mesh_.triangles[t]);
    for (const std::int32_t other : beside_.at(longest_edge(mesh_.triangles[t], shape))) {
      const Vector3d square =
          normals_[other] - shape.along * shape.along.dot(normals_[other]);  // zero: not known yet
      if (other != t && square.norm() > 0.5) {
        normals_[t] = square.normalized();
        return true;
      }
    }
    return false;
  }

  const geometry::Mesh& mesh_;
  std::vector<Vector3d>& normals_;
  std::vector<std::int32_t> open_;
  std::map<Edge, std::vector<std::int32_t>> beside_;
};

}  // namespace

std::vector<Vector3d> triangle_normals(const geometry::Mesh& mesh, double magnitude) {
  constexpr double kThin = 0x1p-38;
  std::vector<Vector3d> normals(mesh.triangles.size(), Vector3d::Zero());
  std::vector<std::int32_t> thin;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Shape shape = shape_of(mesh, mesh.triangles[t]);
    if (shape.upwards.stableNorm() <= kThin * magnitude) {
      thin.push_back(static_cast<std::int32_t>(t));
    } else {
      normals[t] = shape.along.cross(shape.upwards).stableNormalized();
    }
  }
  if (!thin.empty()) {
    ThinTriangles(mesh, normals, std::move(thin)).fill();
  }
  return normals;
}

}  // namespace haptrial::contact
