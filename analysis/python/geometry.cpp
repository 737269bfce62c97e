#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>
#include <string>

#include "analysis/python/meshes.h"
#include "core/base/error.h"
#include "core/geometry/bvh/bvh.h"
#include "core/geometry/files/mesh_io.h"
#include "core/geometry/mesh/mesh.h"
#include "core/geometry/volume/distance_map.h"
#include "core/geometry/volume/tetrahedralize.h"
#include "core/geometry/volume/voxelize.h"

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

namespace {

using geometry::Mesh;

py::tuple read_mesh(const std::string& path) {
  Mesh mesh;
  {
    const py::gil_scoped_release release;
    mesh = geometry::read_mesh(path);
  }
  return py::make_tuple(rows_of<double>(mesh.vertices, 3),
                        rows_of<std::int32_t>(mesh.triangles, 3));
}

struct Solid {
  geometry::Bvh hierarchy;
  geometry::VoxelSolid voxels;
};

Solid solid_of(const Mesh& mesh, int resolution, int margin) {
  geometry::Bvh hierarchy(mesh);
  Eigen::AlignedBox3d box;
  for (const geometry::Triangle& triangle : mesh.triangles) {
    for (const std::int32_t corner : triangle) {
      box.extend(mesh.vertices[static_cast<std::size_t>(corner)]);
    }
  }
  const geometry::VoxelGrid grid = geometry::make_grid(box, resolution, margin);
  geometry::VoxelSolid voxels =
      geometry::voxelize(mesh, grid, geometry::fitting_rule(mesh), {}, &hierarchy);
  return {std::move(hierarchy), std::move(voxels)};
}

/// Voxels as Python has them: the last index runs along x.
std::vector<py::ssize_t> shape_of(const geometry::VoxelGrid& grid) {
  return {grid.size[2], grid.size[1], grid.size[0]};
}

py::dict distance_map(const Numbers& vertices, const Corners& triangles, int resolution, int margin,
                      bool everywhere) {
  const Mesh mesh = mesh_of(vertices, triangles);
  geometry::DistanceMap map;
  std::vector<std::uint8_t> inside;
  {
    const py::gil_scoped_release release;
    const Solid solid = solid_of(mesh, resolution, margin);
    map = geometry::make_distance_map(solid.hierarchy, solid.voxels, {everywhere, false, 0});
    for (const geometry::VoxelLabel label : solid.voxels.labels) {
      inside.push_back(label == geometry::VoxelLabel::kInside ? 1 : 0);
    }
  }
  py::dict result;
  result["distance"] = array_of<double>(std::move(map.distance), shape_of(map.grid));
  result["inside"] = array_of<bool>(std::move(inside), shape_of(map.grid));
  result["origin"] = py::make_tuple(map.grid.origin.x(), map.grid.origin.y(), map.grid.origin.z());
  result["spacing"] = map.grid.spacing;
  return result;
}

py::tuple tetrahedra(const Numbers& vertices, const Corners& triangles, int resolution) {
  const Mesh mesh = mesh_of(vertices, triangles);
  geometry::TetMesh tets;
  {
    const py::gil_scoped_release release;
    tets = geometry::tetrahedralize(solid_of(mesh, resolution, 0).voxels);
  }
  return py::make_tuple(rows_of<double>(tets.vertices, 3),
                        rows_of<std::int32_t>(tets.tetrahedra, 4));
}

/// Distance, nearest point and triangle of each point.
py::tuple nearest(const Numbers& vertices, const Corners& triangles, const Numbers& points) {
  const std::span<const Eigen::Vector3d> asked = points_of(points);
  const Mesh mesh = mesh_of(vertices, triangles);
  if (mesh.triangles.empty()) {
    throw InputError("the mesh has no triangle, so nothing is nearest; allowed: at least one");
  }
  std::vector<double> distance;
  std::vector<Eigen::Vector3d> point;
  std::vector<std::int32_t> triangle;
  {
    const py::gil_scoped_release release;
    std::vector<geometry::ClosestPoint> answers(asked.size());
    geometry::Bvh(mesh).closest(asked, answers);
    for (std::size_t i = 0; i < answers.size(); ++i) {
      const bool found = answers[i].triangle >= 0;  // none of a point that is not finite
      point.push_back(found ? answers[i].point : Eigen::Vector3d::Constant(std::nan("")));
      triangle.push_back(answers[i].triangle);
      distance.push_back((answers[i].point - asked[i]).norm());
    }
  }
  const auto count = static_cast<py::ssize_t>(point.size());
  return py::make_tuple(array_of(std::move(distance)),
                        array_of<double>(std::move(point), {count, 3}),
                        array_of(std::move(triangle)));
}

}  // namespace

void bind_geometry(py::module_& module) {
  module.def("read_mesh", &read_mesh, py::arg("path"));
  module.def("distance_map", &distance_map, py::arg("vertices"), py::arg("triangles"),
             py::arg("resolution"), py::arg("margin"), py::arg("everywhere"));
  module.def("tetrahedra", &tetrahedra, py::arg("vertices"), py::arg("triangles"),
             py::arg("resolution"));
  module.def("nearest", &nearest, py::arg("vertices"), py::arg("triangles"), py::arg("points"));
}

}  // namespace haptrial::python
