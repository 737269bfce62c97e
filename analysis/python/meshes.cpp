#include "analysis/python/meshes.h"

#include "core/base/error.h"

namespace haptrial::python {

geometry::Mesh mesh_of(const Numbers& vertices, const Corners& triangles) {
  if (vertices.ndim() != 2 || vertices.shape(1) != 3 || triangles.ndim() != 2 ||
      triangles.shape(1) != 3) {
    throw InputError("a mesh is not (vertices x 3) and (triangles x 3); allowed: these shapes");
  }
  geometry::Mesh mesh;
  for (py::ssize_t i = 0; i < vertices.shape(0); ++i) {
    mesh.vertices.emplace_back(vertices.at(i, 0), vertices.at(i, 1), vertices.at(i, 2));
  }
  for (py::ssize_t i = 0; i < triangles.shape(0); ++i) {
    mesh.triangles.push_back({triangles.at(i, 0), triangles.at(i, 1), triangles.at(i, 2)});
  }
  return mesh;
}

std::span<const Eigen::Vector3d> points_of(const Numbers& points) {
  static_assert(sizeof(Eigen::Vector3d) == 3 * sizeof(double));
  if (points.ndim() != 2 || points.shape(1) != 3) {
    throw InputError("points are not (points x 3); allowed: this shape");
  }
  return {reinterpret_cast<const Eigen::Vector3d*>(points.data()),
          static_cast<std::size_t>(points.shape(0))};
}

}  // namespace haptrial::python
