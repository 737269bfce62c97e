// Pieces of a bone: the flood, the cost of a split, a cut and a plate for the servo tick, on one
// core. Times are of the wall clock; medians and 99th percentiles.
//
//     bench_pieces BONE               a file that `haptrial bone info` reads
//     bench_pieces --figures FOLDER   Figures 10 and 11 of docs/algorithms, of a made mandible

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <deque>
#include <numbers>
#include <string>
#include <vector>

#include "core/base/random.h"
#include "core/bone/data/load_bone.h"
#include "core/bone/data/procedural_bone.h"
#include "core/bone/model/flood.h"
#include "core/bone/model/world.h"
#include "core/bone/simulator/cut_plane.h"
#include "core/bone/simulator/plate.h"
#include "core/bone/simulator/plate_shapes.h"
#include "tests/benchmarks/pieces_figures.h"

namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using haptrial::bone::BoneModel;
using haptrial::bone::BoneVolume;
using haptrial::bone::BoneWorld;
using haptrial::bone::CutPlane;
using haptrial::bone::CutPlaneTool;
using haptrial::bone::Flood;
using haptrial::bone::Occupancy;
using haptrial::bone::PlateModel;
using haptrial::bone::Voxel;

template <class F>
double seconds(F&& f) {
  const auto start = std::chrono::steady_clock::now();
  f();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

struct Times {
  std::vector<double> all;  // [s]
  double share(double q) {
    std::sort(all.begin(), all.end());
    return all[static_cast<std::size_t>(q * static_cast<double>(all.size() - 1))];
  }
};

template <class F>
Times repeat(int count, F&& f) {
  Times times;
  for (int i = 0; i < count; ++i) {
    times.all.push_back(seconds(f));
  }
  return times;
}

/// The source's flood, voxel by voxel, over flags.
std::size_t flood_by_voxel(const BoneVolume& volume, const Occupancy& occupancy) {
  const auto addresses = static_cast<std::size_t>(volume.bricks()) *
                         static_cast<std::size_t>(BoneVolume::kBrickVoxels);
  std::vector<bool> reached(addresses, false);
  std::size_t parts = 0;
  std::vector<Voxel> open;
  for (std::size_t at = BoneVolume::kBrickVoxels; at < addresses; ++at) {
    if (reached[at] || !occupancy.holds(static_cast<std::int32_t>(at))) {
      continue;
    }
    ++parts;
    reached[at] = true;
    open.assign(1, volume.voxel_at(static_cast<std::int32_t>(at)));
    while (!open.empty()) {
      const Voxel voxel = open.back();
      open.pop_back();
      for (int axis = 0; axis < 3; ++axis) {
        for (const int step : {-1, 1}) {
          const Voxel beside = voxel + step * Voxel::Unit(axis);
          const std::int32_t address = volume.address(beside);
          if (occupancy.holds(address) && !reached[static_cast<std::size_t>(address)]) {
            reached[static_cast<std::size_t>(address)] = true;
            open.push_back(beside);
          }
        }
      }
    }
  }
  return parts;
}

void bench_flood(const BoneModel& model) {
  const BoneVolume volume(model);
  std::vector<Voxel> changed;
  Occupancy occupancy;
  const double first = seconds([&] { occupancy.follow(volume, changed); });
  changed.clear();
  Times idle = repeat(21, [&] { occupancy.follow(volume, changed); });
  Flood flood;
  Times look = repeat(21, [&] { flood.look(volume, occupancy); });
  std::size_t parts = 0;
  Times walk = repeat(5, [&] { parts = flood_by_voxel(volume, occupancy); });
  fmt::print("{}: {} voxels in {} bricks, {} parts, the biggest of {}\n", model.name,
             occupancy.count(), volume.bricks() - 1, flood.parts(), flood.biggest());
  fmt::print("  first look at what it holds {:.2f} ms; looking for changes {:.3f} ms\n",
             1e3 * first, 1e3 * idle.share(0.5));
  fmt::print("  flood {:.2f} ms; voxel by voxel {:.1f} ms ({} parts)\n", 1e3 * look.share(0.5),
             1e3 * walk.share(0.5), parts);
}

/// Across the whole grid, through its middle.
CutPlane across(const haptrial::geometry::VoxelGrid& grid, double depth) {
  CutPlane plane;
  plane.pose_WC = Isometry3d(
      Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), Vector3d(1.0, 0.35, 0.2).normalized()));
  plane.pose_WC.translation() = grid.centre(grid.size[0] / 2, grid.size[1] / 2, grid.size[2] / 2);
  const int longest = *std::max_element(grid.size.begin(), grid.size.end());
  plane.width = plane.height = std::sqrt(3.0) * longest * grid.spacing;
  plane.depth = depth;
  return plane;
}

void bench_cut_and_split(const BoneModel& model) {
  BoneWorld world(model);
  CutPlaneTool tool;
  tool.begin(world, across(model.grid, 1e-3));
  Times cut;
  while (tool.busy()) {
    cut.all.push_back(seconds([&] { tool.step(world); }));
  }
  fmt::print("cut of {:.0f} mm by {:.0f} mm, 1 mm deep: {} voxels in {} ticks\n",
             1e3 * across(model.grid, 1e-3).width, 1e3 * across(model.grid, 1e-3).height,
             tool.removed().voxels, cut.all.size());
  fmt::print("  a tick {:.1f} us, 99 % below {:.1f} us\n", 1e6 * cut.share(0.5),
             1e6 * cut.share(0.99));
  Times search;
  Times move;
  Times idle;
  for (int i = 0; i < 3000; ++i) {
    if (i % 20 == 0) {
      search.all.push_back(seconds([&] { world.search(); }));
    }
    const bool moving = world.pieces() > 1 && !world.is_born(world.pieces() - 1);
    const double tick = seconds([&] { world.step(); });
    (moving ? move : idle).all.push_back(tick);
  }
  fmt::print("pieces: {}; the second one {:.0f} voxels\n", world.pieces(),
             world.pieces() > 1 ? world.volume(1).amount() : 0.0);
  fmt::print("  search {:.2f} ms, at most {:.2f} ms\n", 1e3 * search.share(0.5),
             1e3 * search.share(1.0));
  fmt::print(
      "  a tick that moves up to {} voxels {:.1f} us, 99 % below {:.1f} us; others {:.2f} us\n",
      world.parameters().moves_per_tick, 1e6 * move.share(0.5), 1e6 * move.share(0.99),
      1e6 * idle.share(0.5));
}

void bench_plate(const BoneModel& model) {
  BoneWorld world(model);
  const PlateModel plate("6 holes", make_plate(haptrial::bone::straight_miniplate(6)));
  haptrial::RandomStream random(1, "plates");
  struct Class {
    const char* name;
    int low, high;
    Times times;
  };
  std::vector<Class> classes{
      {"no", 0, 0, {}}, {"1 to 20", 1, 20, {}}, {"21 to 60", 21, 60, {}}, {"over 60", 61, 100, {}}};
  const Vector3d middle =
      model.grid.centre(model.grid.size[0] / 2, model.grid.size[1] / 2, model.grid.size[2] / 2);
  for (int i = 0; i < 4000; ++i) {
    const Vector3d axis(random.normal(), random.normal(), random.normal());
    Isometry3d pose(Eigen::AngleAxisd(random.uniform(0.0, 3.0), axis.normalized()));
    pose.translation() =
        middle + 0.012 * Vector3d(random.normal(), random.normal(), random.normal());
    int touching = 0;
    const double time = seconds([&] { touching = press(plate, pose, world).touching; });
    for (Class& c : classes) {
      if (touching >= c.low && touching <= c.high) {
        c.times.all.push_back(time);
      }
    }
  }
  fmt::print("plate with 100 samples, a tick by samples in bone:\n");
  for (Class& c : classes) {
    if (!c.times.all.empty()) {
      fmt::print("  {:>8}: {:.2f} us, 99 % below {:.2f} us\n", c.name, 1e6 * c.times.share(0.5),
                 1e6 * c.times.share(0.99));
    }
  }
}

}  // namespace

int main(int count, char** arguments) {
  if (count == 3 && std::strcmp(arguments[1], "--figures") == 0) {
    haptrial::bench::draw_pieces(haptrial::bone::make_mandible(), arguments[2]);
    return 0;
  }
  if (count != 2) {
    fmt::print(stderr, "usage: bench_pieces BONE, or bench_pieces --figures FOLDER\n");
    return 2;
  }
  const BoneModel model = haptrial::bone::load_bone(arguments[1]);
  bench_flood(model);
  bench_cut_and_split(model);
  bench_plate(model);
}
