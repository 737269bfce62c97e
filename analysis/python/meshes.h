#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <type_traits>
#include <vector>

#include "analysis/python/arrays.h"
#include "core/geometry/mesh/mesh.h"

namespace haptrial::python {

using Corners = py::array_t<std::int32_t, py::array::c_style | py::array::forcecast>;

/// (vertices x 3) and (triangles x 3) as a mesh. @throws InputError for other shapes
geometry::Mesh mesh_of(const Numbers& vertices, const Corners& triangles);

/// (points x 3), as long as `points` lives. @throws InputError for another shape
std::span<const Eigen::Vector3d> points_of(const Numbers& points);

/// Rows of `width` T each as an array (rows x width).
template <class T, class Rows>
py::array_t<T> rows_of(Rows&& rows, py::ssize_t width) {
  const auto count = static_cast<py::ssize_t>(rows.size());
  using Row = typename std::decay_t<Rows>::value_type;
  return array_of<T>(std::vector<Row>(rows.begin(), rows.end()), {count, width});
}

}  // namespace haptrial::python
