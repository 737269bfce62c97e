#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <optional>

#include "core/base/error.h"
#include "core/geometry/volume/flood_fill.h"
#include "core/geometry/volume/grid_crossings.h"

namespace haptrial::geometry {
namespace {

/// Walls of each voxel: bit a is set if the step to the next voxel along axis a crosses the
/// surface.
using Walls = std::vector<std::uint8_t>;

void build_walls(const GridCrossings& crossings, const VoxelGrid& grid, int axis, Walls& walls) {
  const int u = (axis + 1) % 3;
  const int v = (axis + 2) % 3;
  for (std::size_t line = 0; line < crossings.lines(); ++line) {
    std::array<std::int32_t, 3> at{};
    at[u] = static_cast<std::int32_t>(line % static_cast<std::size_t>(grid.size[u]));
    at[v] = static_cast<std::int32_t>(line / static_cast<std::size_t>(grid.size[u]));
    for (const Crossing& crossing : crossings.on_line(line)) {
      if (crossing.before > 0) {
        at[axis] = crossing.before - 1;
        walls[grid.index(at[0], at[1], at[2])] |= static_cast<std::uint8_t>(1 << axis);
      }
    }
  }
}

bool is_inside(const GridCrossings& along_x, const VoxelGrid& grid,
               const std::array<std::int32_t, 3>& at) {
  const auto line = static_cast<std::size_t>(at[1]) +
                    static_cast<std::size_t>(grid.size[1]) * static_cast<std::size_t>(at[2]);
  bool inside = false;
  for (const Crossing& crossing : along_x.on_line(line)) {
    inside = inside != (crossing.before <= at[0]);
  }
  return inside;
}

/// The voxel that holds a point a short step inside of a triangle, where its centre is inside too.
std::optional<std::size_t> seed(const Mesh& mesh, const VoxelGrid& grid,
                                const GridCrossings& along_x) {
  constexpr double kStep = 0.75;  // voxels: nearly all the way through the one at the surface
  for (const Triangle& t : mesh.triangles) {
    const Eigen::Vector3d& a = mesh.vertices[t[0]];
    const Eigen::Vector3d& b = mesh.vertices[t[1]];
    const Eigen::Vector3d& c = mesh.vertices[t[2]];
    const Eigen::Vector3d outwards = (b - a).cross(c - a).stableNormalized();
    const Eigen::Vector3d middle = (a + b + c) / 3.0;
    for (const double sign : {1.0, -1.0}) {  // the faces may look inwards
      const Eigen::Vector3d point = middle - sign * kStep * grid.spacing * outwards;
      std::array<std::int32_t, 3> at{};
      bool in_grid = true;
      for (int axis = 0; axis < 3; ++axis) {
        const double number = std::round((point[axis] - grid.origin[axis]) / grid.spacing);
        in_grid = in_grid && number >= 0.0 && number < grid.size[axis];
        at[axis] = in_grid ? static_cast<std::int32_t>(number) : 0;
      }
      if (in_grid && is_inside(along_x, grid, at)) {
        return grid.index(at[0], at[1], at[2]);
      }
    }
  }
  return std::nullopt;
}

}  // namespace

void flood_fill(const Mesh& mesh, VoxelSolid& solid, const WorkReport& report) {
  constexpr std::size_t kBetweenReports = 1 << 20;
  const VoxelGrid& grid = solid.grid;
  const GridCrossings along_x(mesh, grid, 0, report);
  const std::optional<std::size_t> start = seed(mesh, grid, along_x);
  if (!start) {
    throw InputError(
        "the centre of no voxel lies inside the mesh; choose a finer resolution, or repair the "
        "mesh if faces are there twice");
  }
  Walls walls(grid.count(), 0);
  build_walls(along_x, grid, 0, walls);
  for (const int axis : {1, 2}) {
    build_walls(GridCrossings(mesh, grid, axis, report), grid, axis, walls);
  }
  const std::array<std::size_t, 3> stride{
      1, static_cast<std::size_t>(grid.size[0]),
      static_cast<std::size_t>(grid.size[0]) * static_cast<std::size_t>(grid.size[1])};
  std::vector<std::size_t> open{*start};
  solid.labels[*start] = VoxelLabel::kInside;
  const auto reach = [&](std::size_t voxel) {
    if (solid.labels[voxel] == VoxelLabel::kOutside) {
      solid.labels[voxel] = VoxelLabel::kInside;
      open.push_back(voxel);
    }
  };
  for (std::size_t filled = 0; !open.empty(); ++filled) {
    if (filled % kBetweenReports == 0) {
      report_share(report, static_cast<double>(filled) / static_cast<double>(grid.count()));
    }
    const std::size_t voxel = open.back();
    open.pop_back();
    for (int axis = 0; axis < 3; ++axis) {
      const std::size_t along = voxel / stride[axis] % static_cast<std::size_t>(grid.size[axis]);
      if (along > 0 && (walls[voxel - stride[axis]] >> axis & 1) == 0) {
        reach(voxel - stride[axis]);
      }
      if (along + 1 < static_cast<std::size_t>(grid.size[axis]) &&
          (walls[voxel] >> axis & 1) == 0) {
        reach(voxel + stride[axis]);
      }
    }
  }
}

}  // namespace haptrial::geometry
