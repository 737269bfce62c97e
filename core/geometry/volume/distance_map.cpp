#include "core/geometry/volume/distance_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "core/base/parallel.h"
#include "core/geometry/bvh/bvh_kernel.h"

namespace haptrial::geometry {
namespace {

constexpr int kSide = 16;  // voxels along a brick
constexpr int kBrick = kSide * kSide * kSide;

/// The voxels of a brick in the order in which they are searched: sixteen in a row are a block of
/// 4 x 2 x 2, and blocks follow each other along a Morton curve.
const std::array<std::array<std::uint8_t, 3>, kBrick>& brick_order() {
  static const auto order = [] {
    std::array<std::array<std::uint8_t, 3>, kBrick> places{};
    for (int at = 0; at < kBrick; ++at) {
      // Bits of `at` from the lowest: x x y z, then z y x in turn, as far as each has bits.
      std::array<int, 3> place{at & 3, (at >> 2) & 1, (at >> 3) & 1};
      std::array<int, 3> bit{2, 1, 1};
      for (int rest = at >> 4, axis = 2; rest != 0; axis = (axis + 2) % 3) {
        if (bit[axis] == 4) {
          continue;
        }
        place[axis] |= (rest & 1) << bit[axis]++;
        rest >>= 1;
      }
      for (int axis = 0; axis < 3; ++axis) {
        places[at][axis] = static_cast<std::uint8_t>(place[axis]);
      }
    }
    return places;
  }();
  return order;
}

/// Fills a map, one brick at a time.
class Filler {
 public:
  Filler(const Bvh& bvh, const VoxelSolid& solid, bool everywhere, DistanceMap& map)
      : bvh_(bvh), solid_(solid), everywhere_(everywhere), map_(map) {
    for (int axis = 0; axis < 3; ++axis) {
      bricks_[axis] = (map.grid.size[axis] + kSide - 1) / kSide;
    }
  }

  std::size_t bricks() const {
    return std::size_t(bricks_[0]) * std::size_t(bricks_[1]) * std::size_t(bricks_[2]);
  }

  void fill(std::size_t brick) {
    std::array<std::int32_t, 3> first;
    for (int axis = 0; axis < 3; ++axis) {
      first[axis] = static_cast<std::int32_t>(brick % std::size_t(bricks_[axis])) * kSide;
      brick /= std::size_t(bricks_[axis]);
    }
    std::vector<Eigen::Vector3d> points;
    std::vector<std::size_t> voxels;
    points.reserve(kBrick);
    voxels.reserve(kBrick);
    for (const auto& place : brick_order()) {
      const std::int32_t i = first[0] + place[0], j = first[1] + place[1], k = first[2] + place[2];
      const auto& size = map_.grid.size;
      if (i >= size[0] || j >= size[1] || k >= size[2]) {
        continue;
      }
      const std::size_t voxel = map_.grid.index(i, j, k);
      if (!everywhere_ && solid_.labels[voxel] != VoxelLabel::kInside) {
        continue;
      }
      points.push_back(map_.grid.centre(i, j, k));
      voxels.push_back(voxel);
    }
    std::vector<ClosestPoint> answers(points.size());
    bvh_.data().kernels->many(bvh_.data(), points.data(), points.size(), answers.data());
    for (std::size_t i = 0; i < voxels.size(); ++i) {
      write(voxels[i], answers[i]);
    }
  }

 private:
  void write(std::size_t voxel, const ClosestPoint& nearest) {
    const double distance = std::sqrt(nearest.distance_squared);
    const bool inside = solid_.labels[voxel] == VoxelLabel::kInside;
    map_.distance[voxel] = inside ? -distance : distance;
    if (map_.point.empty()) {
      return;
    }
    map_.point[voxel] = nearest.point;
    map_.triangle[voxel] = nearest.triangle;
  }

  const Bvh& bvh_;
  const VoxelSolid& solid_;
  bool everywhere_;
  DistanceMap& map_;
  std::array<std::int32_t, 3> bricks_;
};

}  // namespace

DistanceMap make_distance_map(const Bvh& bvh, const VoxelSolid& solid,
                              const DistanceMapOptions& options, const WorkReport& report) {
  const std::size_t count = solid.grid.count();
  if (solid.labels.size() != count) {
    throw std::invalid_argument("make_distance_map: the solid has not one label per voxel");
  }
  constexpr double kUnasked = std::numeric_limits<double>::quiet_NaN();
  DistanceMap map{solid.grid, std::vector<double>(count, kUnasked), {}, {}};
  if (options.points) {
    map.point.assign(count, Eigen::Vector3d::Constant(kUnasked));
    map.triangle.assign(count, -1);
  }
  if (bvh.triangles() == 0) {
    return map;
  }
  Filler filler(bvh, solid, options.everywhere, map);
  const std::size_t bricks = filler.bricks();
  const int threads = threads_or_all(options.threads);
  const std::size_t batch = std::max(bricks / 200, 8 * static_cast<std::size_t>(threads));
  for (std::size_t first = 0; first < bricks; first += batch) {
    report_share(report, static_cast<double>(first) / static_cast<double>(bricks));
    parallel_for(std::min(batch, bricks - first), threads,
                 [&](std::size_t i) { filler.fill(first + i); });
  }
  report_share(report, 1.0);
  return map;
}

double distance_map_memory(const VoxelGrid& grid, const DistanceMapOptions& options) {
  const double of_voxel = sizeof(double) + (options.points ? 3 * sizeof(double) + 4 : 0);
  return of_voxel * static_cast<double>(grid.count());
}

}  // namespace haptrial::geometry
