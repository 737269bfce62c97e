#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <span>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/base/nearest.h"
#include "core/geometry/bvh/bvh.h"
#include "core/geometry/files/mesh_io.h"
#include "core/geometry/files/tet_files.h"
#include "core/geometry/files/volume_files.h"
#include "core/geometry/mesh/procedural.h"
#include "core/geometry/volume/distance_map.h"
#include "core/geometry/volume/mesh_check.h"
#include "core/geometry/volume/mesh_repair.h"
#include "core/geometry/volume/tetrahedralize.h"
#include "core/render/mesh/distance_slice.h"
#include "core/render/mesh/mesh_scene.h"
#include "experiments/command/arguments.h"
#include "experiments/command/mesh_command.h"
#include "experiments/command/subcommand.h"

namespace haptrial::experiments {
namespace {

struct MeshOptions {
  MeshInput input;
  std::string out;
  std::string shape;
  std::string picture;
  std::string up{"y"};
  double weld{0.0};
  VoxelizeOptions voxels;
  bool everywhere{false};
  std::string points;
  bool overwrite{false};
};

using Clock = std::chrono::steady_clock;

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

/// An empty solid is more often a mesh without an inside than one that was meant so.
void warn_if_empty(const VoxelizedMesh& made) {
  if (geometry::count_inside(made.solid) == 0) {
    fmt::print(stderr,
               "WARNING: no voxel is inside. Choose a finer resolution, or see with haptrial mesh "
               "info whether the mesh is open or its faces look both ways.\n");
  }
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
  warn_if_empty(made);
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

double milliseconds_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

/// The slice across the axis after `up`, through the middle.
void draw_slice(const geometry::DistanceMap& map, int up, const std::string& file) {
  const geometry::VoxelGrid& grid = map.grid;
  const int across = (up + 1) % 3, along = (up + 2) % 3;
  render::DistanceSlice slice{{}, grid.size[along], grid.size[up], grid.spacing};
  std::vector<double> values;
  std::array<std::int32_t, 3> voxel;
  voxel[across] = grid.size[across] / 2;
  for (voxel[up] = 0; voxel[up] < grid.size[up]; ++voxel[up]) {
    for (voxel[along] = 0; voxel[along] < grid.size[along]; ++voxel[along]) {
      values.push_back(map.distance[grid.index(voxel[0], voxel[1], voxel[2])]);
    }
  }
  slice.values = values;
  constexpr int kPixels = 450;
  render::write_png(file, render::draw_distances(slice, kPixels));
}

void print_map(const geometry::DistanceMap& map) {
  double deepest = 0.0, farthest = 0.0;
  std::size_t count = 0;
  for (const double distance : map.distance) {
    if (std::isnan(distance)) {
      continue;
    }
    ++count;
    deepest = std::min(deepest, distance);
    farthest = std::max(farthest, distance);
  }
  fmt::print("distances   of {} voxels; deepest {:.6g} m, farthest outside {:.6g} m\n", count,
             std::abs(deepest), farthest);
}

int mesh_distance(const MeshOptions& options) {
  const MemoryBudget budget(options.input.max_memory);
  geometry::check_volume_ending(options.out);
  if (!options.points.empty()) {
    geometry::check_volume_ending(options.points);
  }
  for (const std::string& file : {options.out, options.points, options.picture}) {
    check_new(file, options.overwrite);
  }
  view_with_up(options.up);
  const geometry::Mesh mesh = load_mesh(options.input, budget);
  const VoxelizedMesh made = voxelize_mesh(mesh, options.voxels, budget);
  const geometry::DistanceMapOptions wanted{.everywhere = options.everywhere,
                                            .points = !options.points.empty()};
  warn_if_empty(made);
  budget.check("the distance map", geometry::distance_map_memory(made.solid.grid, wanted));

  Clock::time_point start = Clock::now();
  const geometry::Bvh hierarchy(mesh);
  fmt::print("hierarchy   of {} triangles in {:.1f} ms\n", mesh.triangles.size(),
             milliseconds_since(start));
  start = Clock::now();
  const geometry::DistanceMap map = [&] {
    ShownWork work("distances");
    return geometry::make_distance_map(hierarchy, made.solid, wanted, work.report());
  }();
  const double spent = milliseconds_since(start);
  print_map(map);
  fmt::print("measured    in {:.1f} ms\n", spent);

  geometry::write_volume(options.out,
                         {map.grid, std::span<const double>(map.distance), 1,
                          "distance to the surface [m], negative inside"},
                         options.overwrite);
  fmt::print("wrote       {}\n", options.out);
  if (!options.points.empty()) {
    const std::span<const double> places(map.point.front().data(), 3 * map.point.size());
    geometry::write_volume(options.points, {map.grid, places, 3, "nearest point [m]"},
                           options.overwrite);
    fmt::print("wrote       {}\n", options.points);
  }
  if (!options.picture.empty()) {
    draw_slice(map, options.up[0] - 'x', options.picture);
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
  const auto start = Clock::now();
  const geometry::TetMesh tets = geometry::tetrahedralize(made.solid);
  const double spent = milliseconds_since(start);
  const auto surface = std::count(tets.on_surface.begin(), tets.on_surface.end(), 1);
  fmt::print("mesh        {} tetrahedra, {} vertices, {} of them at the surface, in {:.1f} ms\n",
             tets.tetrahedra.size(), tets.vertices.size(), surface, spent);
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

/// A subcommand that reads or writes meshes.
struct MeshCommand {
  CLI::App& sub;
  MeshOptions& o;

  void add_input() const {
    sub.add_option("IN", o.input.file, "Mesh (.obj, .ply, .stl)")->required();
    sub.add_option("--scale", o.input.scale,
                   with_default("Length of one unit of the file [m]", o.input.scale));
    sub.add_option("--max-memory", o.input.max_memory, kMemoryHelp);
  }
  void add_output(const char* what) const { sub.add_option("OUT", o.out, what)->required(); }
  void add_resolution() const {
    sub.add_option("--resolution", o.voxels.resolution,
                   with_default("Number of voxels along the longest axis", o.voxels.resolution));
  }
  void add_rule() const {
    sub.add_option(
        "--inside", o.voxels.rule,
        with_default("Rule for inside voxels: auto, parity, winding or flood", o.voxels.rule));
  }
  void add_voxels() const {
    add_resolution();
    sub.add_flag("--over", o.voxels.over, "Extend the solid one voxel beyond the surface");
    add_rule();
  }
  void add_picture(const char* what) const {
    sub.add_option("--picture", o.picture, what);
    sub.add_option("--up", o.up,
                   with_default("Axis that points up in the picture: x, y or z", o.up));
  }
};

constexpr const char* kNewMesh = "New mesh (.obj, .ply, .stl)";
constexpr const char* kNewPicture = "New picture (.png)";

MeshCommand begin(CLI::App* sub, int& status, int (*command)(const MeshOptions&)) {
  auto& o = options_of<MeshOptions>(*sub, status, command);
  sub->add_flag("--overwrite", o.overwrite, "Overwrite existing files");
  return {*sub, o};
}

void add_mesh_make(CLI::App& mesh, int& status) {
  const MeshCommand make =
      begin(subcommand(mesh, "make", "Make an example mesh", "haptrial mesh make gear gear.ply"),
            status, mesh_make);
  make.sub.add_option("SHAPE", make.o.shape, "Shape: sphere, torus, gear or rough")->required();
  make.add_output(kNewMesh);
}

void add_mesh_info(CLI::App& mesh, int& status) {
  const MeshCommand info = begin(
      subcommand(mesh, "info", "Describe a mesh and its defects", "haptrial mesh info gear.ply"),
      status, mesh_info);
  info.add_input();
  info.add_picture(kNewPicture);
}

void add_mesh_repair(CLI::App& mesh, int& status) {
  const MeshCommand repair =
      begin(subcommand(mesh, "repair", "Weld, clean and orient a mesh",
                       "haptrial mesh repair scan.stl clean.ply --weld 1e-5"),
            status, mesh_repair);
  repair.add_input();
  repair.add_output(kNewMesh);
  repair.sub.add_option(
      "--weld", repair.o.weld,
      with_default("Distance within which vertices are merged [m]", repair.o.weld));
}

void add_mesh_voxelize(CLI::App& mesh, int& status) {
  const MeshCommand voxelize =
      begin(subcommand(mesh, "voxelize", "Label the voxels of a grid as inside or outside",
                       "haptrial mesh voxelize gear.ply gear.nrrd --resolution 135"),
            status, mesh_voxelize);
  voxelize.add_input();
  voxelize.add_output("New volume (.nrrd, .h5)");
  voxelize.add_voxels();
  voxelize.add_picture(kNewPicture);
}

void add_mesh_distance(CLI::App& mesh, int& status) {
  const MeshCommand distance =
      begin(subcommand(mesh, "distance", "Compute the exact distance of every voxel to the surface",
                       "haptrial mesh distance gear.ply gear-distance.nrrd --everywhere"),
            status, mesh_distance);
  distance.add_input();
  distance.add_output("New volume of distances [m] (.nrrd, .h5)");
  distance.add_resolution();
  distance.add_rule();
  distance.sub.add_flag("--everywhere", distance.o.everywhere,
                        "Compute the positive distances outside, too");
  distance.sub.add_option(
      "--margin", distance.o.voxels.margin,
      with_default("Number of extra voxels on every side", distance.o.voxels.margin));
  distance.sub.add_option("--points", distance.o.points,
                          "New volume of nearest points [m] (.nrrd, .h5)");
  distance.add_picture("New picture of the slice in the middle (.png)");
}

void add_mesh_tetrahedralize(CLI::App& mesh, int& status) {
  const MeshCommand split =
      begin(subcommand(mesh, "tetrahedralize", "Fill a mesh with tetrahedra, five to a voxel",
                       "haptrial mesh tetrahedralize gear.ply gear.vtu --resolution 40"),
            status, mesh_tetrahedralize);
  split.add_input();
  split.add_output("New mesh (.node with .ele, .vtu, .h5)");
  split.add_voxels();
  split.add_picture(kNewPicture);
}

}  // namespace

void add_mesh(CLI::App& app, int& status) {
  CLI::App* mesh =
      subcommand(app, "mesh", "Check, repair, voxelize, measure and split surface meshes",
                 "haptrial mesh tetrahedralize bunny.ply bunny.vtu", {"", "algorithms/meshes.md"});
  mesh->require_subcommand(1);
  add_mesh_make(*mesh, status);
  add_mesh_info(*mesh, status);
  add_mesh_repair(*mesh, status);
  add_mesh_voxelize(*mesh, status);
  add_mesh_distance(*mesh, status);
  add_mesh_tetrahedralize(*mesh, status);
}

}  // namespace haptrial::experiments
