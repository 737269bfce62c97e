#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>

#include "core/base/error.h"
#include "core/base/nearest.h"
#include "core/geometry/files/mesh_io.h"
#include "core/geometry/files/tet_files.h"
#include "core/geometry/files/volume_files.h"
#include "core/geometry/mesh/procedural.h"
#include "core/geometry/volume/mesh_check.h"
#include "core/geometry/volume/mesh_repair.h"
#include "core/geometry/volume/tetrahedralize.h"
#include "core/render/mesh/mesh_scene.h"
#include "experiments/command/mesh_command.h"
#include "experiments/command/tools/tool_commands.h"

namespace haptrial::experiments {
namespace {

constexpr render::Colour kBone{0.86, 0.80, 0.70};

void print_voxels(const VoxelizedMesh& made) {
  const geometry::VoxelGrid& grid = made.solid.grid;
  const std::size_t inside = geometry::count_inside(made.solid);
  const auto border =
      std::count(made.solid.labels.begin(), made.solid.labels.end(), geometry::VoxelLabel::kBorder);
  fmt::print("grid        {} x {} x {} voxels of {:.6g} m\n", grid.size[0], grid.size[1],
             grid.size[2], grid.spacing);
  fmt::print("inside      {} voxels by {}, {:.6g} m3; {} more touch them\n", inside,
             name_of(made.rule), static_cast<double>(inside) * std::pow(grid.spacing, 3), border);
  fmt::print("voxelized   in {:.1f} ms\n", 1e3 * made.seconds);
}

/// Edges, components and orders of a mesh while it is looked at, and its hierarchy in a repair.
void check_room(const geometry::Mesh& mesh, double bytes_per_triangle, const MemoryBudget& budget) {
  constexpr double kPerVertex = 100.0;
  budget.check(fmt::format("looking at {} triangles", mesh.triangles.size()),
               bytes_per_triangle * static_cast<double>(mesh.triangles.size()) +
                   kPerVertex * static_cast<double>(mesh.vertices.size()));
}

geometry::Mesh made_mesh(const MeshOptions& options) {
  if (options.shape == "sphere") {
    return geometry::make_sphere(0.05, 32);
  }
  if (options.shape == "torus") {
    return geometry::make_torus(0.05, 0.02, 120, 60);
  }
  if (options.shape == "gear") {
    return geometry::make_gear();
  }
  if (options.shape == "rough") {
    constexpr int kFrequency = 100;  // 200,000 triangles
    return geometry::make_rough_solid(0.1, kFrequency, 1);
  }
  throw InputError(not_allowed("the shape", fmt::format("'{}'", options.shape),
                               {"sphere", "torus", "gear", "rough"}));
}

}  // namespace

int mesh_make(const MeshOptions& options) {
  const geometry::Mesh mesh = made_mesh(options);
  geometry::write_mesh(options.out, mesh, options.overwrite);
  fmt::print("wrote       {}: {} triangles\n", options.out, mesh.triangles.size());
  return 0;
}

int mesh_info(const MeshOptions& options) {
  const MemoryBudget budget(options.input.max_memory);
  render::SceneView view = view_with_up(options.up);
  const geometry::Mesh mesh = load_mesh(options.input, budget);
  check_room(mesh, 250.0, budget);
  for (const std::string& line : geometry::describe(geometry::check_mesh(mesh))) {
    fmt::print("{}\n", line);
  }
  fmt::print("inside      by {}\n", name_of(geometry::fitting_rule(mesh)));
  if (!options.picture.empty()) {
    view.edges = mesh.triangles.size() < 3000;
    write_picture(options.picture, render::scene_of(mesh, kBone), view, options.overwrite);
  }
  return 0;
}

int mesh_repair(const MeshOptions& options) {
  const MemoryBudget budget(options.input.max_memory);
  geometry::mesh_format(options.out);
  check_new(options.out, options.overwrite);
  if (!(options.weld >= 0.0) || !std::isfinite(options.weld)) {
    throw InputError(fmt::format("--weld is {}; allowed: 0 or more [m]", options.weld));
  }
  geometry::Mesh mesh = load_mesh(options.input, budget);
  check_room(mesh, 500.0, budget);
  const geometry::RepairReport done = geometry::repair(mesh, {.weld_tolerance = options.weld});
  fmt::print("welded      {} vertices\n", done.welded_vertices);
  fmt::print("removed     {} degenerate and {} duplicate triangles, {} unused vertices\n",
             done.degenerate_triangles, done.duplicate_triangles, done.unreferenced_vertices);
  fmt::print("turned      {} triangles\n", done.turned_triangles);
  for (const std::string& line : geometry::describe(geometry::check_mesh(mesh))) {
    fmt::print("{}\n", line);
  }
  geometry::write_mesh(options.out, mesh, options.overwrite);
  fmt::print("wrote       {}\n", options.out);
  return 0;
}

int mesh_voxelize(const MeshOptions& options) {
  const MemoryBudget budget(options.input.max_memory);
  geometry::check_volume_ending(options.out);
  check_new(options.out, options.overwrite);
  render::SceneView view = view_with_up(options.up);
  const geometry::Mesh mesh = load_mesh(options.input, budget);
  const VoxelizedMesh made = voxelize_mesh(mesh, options.voxels, budget);
  print_voxels(made);
  geometry::write_volume(options.out, geometry::volume_of(made.solid), options.overwrite);
  fmt::print("wrote       {}\n", options.out);
  if (!options.picture.empty()) {
    constexpr int kFewVoxels = 150;  // along the longest axis: their edges are told apart
    view.edges = options.voxels.resolution <= kFewVoxels;
    const render::Cut cut = render::halfway(geometry::bounds(mesh), view);
    write_picture(options.picture, render::scene_of(made.solid, cut), view, options.overwrite);
  }
  return 0;
}

int mesh_tetrahedralize(const MeshOptions& options) {
  const MemoryBudget budget(options.input.max_memory);
  geometry::check_tet_ending(options.out);
  check_new(options.out, options.overwrite);
  render::SceneView view = view_with_up(options.up);
  const geometry::Mesh mesh = load_mesh(options.input, budget);
  const VoxelizedMesh made = voxelize_mesh(mesh, options.voxels, budget);
  print_voxels(made);
  const std::size_t inside = geometry::count_inside(made.solid);
  budget.check(fmt::format("{} tetrahedra", 5 * inside),
               geometry::tetrahedralizing_memory(made.solid.grid, inside));
  const auto start = std::chrono::steady_clock::now();
  const geometry::TetMesh tets = geometry::tetrahedralize(made.solid);
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const auto surface = std::count(tets.on_surface.begin(), tets.on_surface.end(), 1);
  fmt::print("mesh        {} tetrahedra, {} vertices, {} of them at the surface, in {:.1f} ms\n",
             tets.tetrahedra.size(), tets.vertices.size(), surface, 1e3 * seconds);
  {
    ShownWork work("writing");
    geometry::write_tet_mesh(options.out, tets, options.overwrite, work.report());
  }
  fmt::print("wrote       {}\n", options.out);
  if (!options.picture.empty()) {
    view.edges = true;
    const render::Cut cut = render::halfway(geometry::bounds(mesh), view);
    write_picture(options.picture, render::scene_of(tets, cut), view, options.overwrite);
  }
  return 0;
}

}  // namespace haptrial::experiments
