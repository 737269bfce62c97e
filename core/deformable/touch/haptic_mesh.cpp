#include "core/deformable/touch/haptic_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/error.h"
#include "core/deformable/body/load_case.h"
#include "core/geometry/mesh/mesh_size.h"
#include "core/geometry/volume/hanging_voxels.h"
#include "core/geometry/volume/voxelize.h"

namespace haptrial::deformable {

using Eigen::Vector3d;

namespace {

constexpr double kFlattest = 0.2;  // of a cell: its shortest side over its longest
constexpr std::array<std::string_view, 6> kSideNames{"left", "right", "bottom",
                                                     "top",  "back",  "front"};

std::array<int, 3> cells_of(const Vector3d& size, int cells) {
  const double side = size.maxCoeff() / cells;
  std::array<int, 3> counts{};
  for (int axis = 0; axis < 3; ++axis) {
    counts[static_cast<std::size_t>(axis)] =
        std::max(1, static_cast<int>(std::lround(size[axis] / side)));
  }
  return counts;
}

Eigen::AlignedBox3d box_of(const geometry::TetMesh& tets) {
  Eigen::AlignedBox3d box;
  for (const Vector3d& vertex : tets.vertices) {
    box.extend(vertex);
  }
  return box;
}

bool is_on(const HapticMesh& mesh, std::int32_t vertex, BodySide side) {
  const int axis = static_cast<int>(side) / 2;
  const bool high = static_cast<int>(side) % 2 == 1;
  const double wall = high ? mesh.box.max()[axis] : mesh.box.min()[axis];
  const double at = mesh.tets.vertices[static_cast<std::size_t>(vertex)][axis];
  return std::abs(at - wall) < 1e-6 * mesh.spacing;
}

void check_held(const HapticMesh& mesh) {
  LoadCase load;
  load.name = mesh.name;
  for (std::size_t v = 0; v < mesh.held.size(); ++v) {
    if (mesh.held[v] != 0) {
      load.holds.push_back({static_cast<std::int32_t>(v), Vector3d::Zero()});
    }
  }
  if (load.holds.empty()) {
    throw InputError(fmt::format("{}: nothing holds the body; name a side in `fixed`", mesh.name));
  }
  load.forces.push_back({0, Vector3d::UnitX()});
  check_load(mesh.tets, load);
}

/// Finishes a mesh once its tetrahedra are known.
void finish(HapticMesh& mesh, const FeltSides& sides) {
  mesh.box = box_of(mesh.tets);
  mesh.held.assign(mesh.tets.vertices.size(), 0);
  for (std::size_t v = 0; v < mesh.held.size(); ++v) {
    mesh.held[v] = std::ranges::any_of(sides.fixed, [&](BodySide side) {
      return is_on(mesh, static_cast<std::int32_t>(v), side);
    });
  }
  for (std::size_t v = 0; v < mesh.held.size(); ++v) {
    const auto vertex = static_cast<std::int32_t>(v);
    if (mesh.held[v] == 0 && std::ranges::any_of(sides.grasped, [&](BodySide side) {
          return is_on(mesh, vertex, side);
        })) {
      mesh.grasped.push_back(vertex);
    }
  }
  if (!sides.grasped.empty() && mesh.grasped.empty()) {
    throw InputError(fmt::format(
        "{}: there is nothing to grasp; name a side in `grasped` that is not fixed", mesh.name));
  }
  check_body(mesh.tets, mesh.name);
  check_held(mesh);
  const auto all_of = [](const Face& face, auto&& test) { return std::ranges::all_of(face, test); };
  for (const Face& face : mesh_parts(mesh.tets.tetrahedra).surface) {
    const bool held =
        all_of(face, [&](std::int32_t v) { return mesh.held[static_cast<std::size_t>(v)] != 0; });
    const bool asked = sides.felt.empty() || std::ranges::any_of(sides.felt, [&](BodySide side) {
                         return all_of(face, [&](std::int32_t v) { return is_on(mesh, v, side); });
                       });
    if (!held && asked) {
      mesh.felt.push_back(face);
    }
  }
  if (mesh.felt.empty()) {
    throw InputError(fmt::format(
        "{}: no face can be touched; name a side in `felt` that is not fixed", mesh.name));
  }
}

}  // namespace

std::string_view name_of(BodySide side) { return kSideNames[static_cast<std::size_t>(side)]; }

bool same_mesh(const HapticMesh& a, const HapticMesh& b) {
  return a.name == b.name && a.held == b.held && a.grasped == b.grasped && a.felt == b.felt &&
         std::ranges::equal(a.tets.tetrahedra, b.tets.tetrahedra) &&
         std::ranges::equal(a.tets.vertices, b.tets.vertices);
}

double felt_block_vertices(const Vector3d& size, int cells) {
  double vertices = 1.0;
  for (const int count : cells_of(size, cells)) {
    vertices *= count + 1.0;
  }
  return vertices;
}

/// @throws InputError before more is made than could be prepared
void check_cells(double vertices, int cells, const std::string& name) {
  if (vertices > kMostFeltVertices) {
    throw InputError(fmt::format(
        "{}{}cells = {} make about {:.0f} vertices; allowed: up to {:.0f}; lower `cells`", name,
        name.empty() ? "" : ": ", cells, vertices, kMostFeltVertices));
  }
}

HapticMesh felt_block(const Vector3d& size, int cells, const FeltSides& sides, std::string name) {
  check_cells(felt_block_vertices(size, cells), cells, name);
  const std::array<int, 3> counts = cells_of(size, cells);
  const Vector3d cell(size[0] / counts[0], size[1] / counts[1], size[2] / counts[2]);
  if (cell.minCoeff() < kFlattest * cell.maxCoeff()) {
    throw InputError(fmt::format(
        "{}: its cells are {:.3g} x {:.3g} x {:.3g} m, which is too flat; raise `cells`", name,
        cell[0], cell[1], cell[2]));
  }
  geometry::VoxelSolid solid;
  solid.grid.size = {counts[0], counts[1], counts[2]};
  solid.grid.origin = Vector3d::Constant(0.5);  // corners lie at whole numbers
  solid.labels.assign(solid.grid.count(), geometry::VoxelLabel::kInside);
  HapticMesh mesh;
  mesh.name = std::move(name);
  mesh.spacing = cell.maxCoeff();
  geometry::tetrahedralize(solid, mesh.tets);
  for (Vector3d& vertex : mesh.tets.vertices) {
    vertex = vertex.array().round() * cell.array() - 0.5 * size.array();
  }
  finish(mesh, sides);
  return mesh;
}

HapticMesh felt_solid(const geometry::Mesh& surface, int cells, const FeltSides& sides,
                      std::string name) {
  HapticMesh mesh;
  mesh.name = std::move(name);
  try {
    const geometry::VoxelGrid grid = geometry::make_grid(geometry::bounds(surface), cells);
    mesh.spacing = grid.spacing;
    geometry::VoxelSolid solid = geometry::voxelize(surface, grid, geometry::fitting_rule(surface));
    geometry::drop_hanging_voxels(solid);
    // Each has a corner of its own, but for those at the rims.
    check_cells(
        static_cast<double>(std::ranges::count(solid.labels, geometry::VoxelLabel::kInside)), cells,
        "");
    geometry::tetrahedralize(solid, mesh.tets);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", mesh.name, error.what()));
  }
  finish(mesh, sides);
  return mesh;
}

}  // namespace haptrial::deformable
