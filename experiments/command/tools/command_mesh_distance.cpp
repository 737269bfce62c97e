#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <span>
#include <vector>

#include "core/base/error.h"
#include "core/geometry/bvh/bvh.h"
#include "core/geometry/files/volume_files.h"
#include "core/geometry/volume/distance_map.h"
#include "core/render/mesh/distance_slice.h"
#include "experiments/command/mesh_command.h"
#include "experiments/command/tools/tool_commands.h"

namespace haptrial::experiments {
namespace {

using Clock = std::chrono::steady_clock;

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
             -deepest, farthest);
}

}  // namespace

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

}  // namespace haptrial::experiments
