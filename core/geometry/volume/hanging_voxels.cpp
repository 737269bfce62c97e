#include "core/geometry/volume/hanging_voxels.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <numeric>
#include <set>
#include <utility>
#include <vector>

#include "core/base/error.h"

namespace haptrial::geometry {
namespace {

using Place = std::array<std::int32_t, 3>;

/// The parts of a solid whose voxels are joined by faces.
class JoinedParts {
 public:
  explicit JoinedParts(const VoxelSolid& solid) : solid_(solid), part_(solid.labels.size(), kNone) {
    for_inside([&](const Place& at) {
      if (part_[index(at)] == kNone) {
        join_from(at);
      }
    });
  }

  std::size_t count() const { return sizes_.size(); }
  std::size_t size(std::size_t part) const { return sizes_[part]; }
  std::size_t of_voxel(std::size_t voxel) const { return static_cast<std::size_t>(part_[voxel]); }

  /// The corners that pairs of parts share, each pair both ways.
  std::map<std::pair<std::size_t, std::size_t>, std::set<Place>> shared() const {
    std::map<std::pair<std::size_t, std::size_t>, std::set<Place>> pairs;
    for_inside([&](const Place& at) {
      for (int side = 0; side < 27; ++side) {
        const Place to{at[0] + side % 3 - 1, at[1] + side / 3 % 3 - 1, at[2] + side / 9 - 1};
        if (is_inside(to) && part_[index(to)] != part_[index(at)]) {
          add_corners(at, to, pairs[{of_voxel(index(at)), of_voxel(index(to))}]);
        }
      }
    });
    return pairs;
  }

 private:
  static constexpr std::int32_t kNone = -1;

  static void add_corners(const Place& a, const Place& b, std::set<Place>& corners) {
    for (int corner = 0; corner < 8; ++corner) {
      Place place;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        place[axis] =
            a[axis] == b[axis] ? a[axis] + (corner >> axis) % 2 : std::max(a[axis], b[axis]);
      }
      corners.insert(place);
    }
  }

  std::size_t index(const Place& at) const { return solid_.grid.index(at[0], at[1], at[2]); }
  bool is_inside(const Place& at) const {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (at[axis] < 0 || at[axis] >= solid_.grid.size[axis]) {
        return false;
      }
    }
    return solid_.labels[index(at)] == VoxelLabel::kInside;
  }

  template <class Visit>
  void for_inside(const Visit& visit) const {
    const Place& size = solid_.grid.size;
    for (Place at{0, 0, 0}; at[2] < size[2]; ++at[2]) {
      for (at[1] = 0; at[1] < size[1]; ++at[1]) {
        for (at[0] = 0; at[0] < size[0]; ++at[0]) {
          if (is_inside(at)) {
            visit(at);
          }
        }
      }
    }
  }

  void join_from(const Place& start) {
    const auto number = static_cast<std::int32_t>(sizes_.size());
    std::vector<Place> open{start};
    part_[index(start)] = number;
    sizes_.push_back(0);
    while (!open.empty()) {
      const Place at = open.back();
      open.pop_back();
      ++sizes_.back();
      for (std::size_t side = 0; side < 6; ++side) {
        Place to = at;
        to[side / 2] += side % 2 == 0 ? 1 : -1;
        if (is_inside(to) && part_[index(to)] == kNone) {
          part_[index(to)] = number;
          open.push_back(to);
        }
      }
    }
  }

  const VoxelSolid& solid_;
  std::vector<std::int32_t> part_;  // of each voxel
  std::vector<std::size_t> sizes_;  // voxels of each part
};

}  // namespace

/// Whether all lie on one line, around which a part could swing.
static bool on_a_line(const std::set<Place>& corners) {
  const auto vector = [&](const Place& to) {
    const Place& from = *corners.begin();
    return Eigen::Vector3i(to[0] - from[0], to[1] - from[1], to[2] - from[2]);
  };
  const Eigen::Vector3i along = vector(*corners.rbegin());
  return std::ranges::all_of(
      corners, [&](const Place& corner) { return vector(corner).cross(along).isZero(); });
}

std::size_t drop_hanging_voxels(VoxelSolid& solid) {
  constexpr double kSmallPart = 0.05;
  const JoinedParts parts(solid);
  const auto shared = parts.shared();
  std::vector<std::size_t> order(parts.count());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, std::greater<>(), [&](std::size_t p) { return parts.size(p); });
  std::vector<bool> hangs(parts.count(), false);
  std::size_t all = 0;
  for (std::size_t n = 0; n < order.size(); ++n) {
    all += parts.size(order[n]);
    std::set<Place> corners;
    for (std::size_t larger = 0; larger < n; ++larger) {
      const auto pair = shared.find({order[n], order[larger]});
      if (pair != shared.end() && !hangs[order[larger]]) {
        corners.insert(pair->second.begin(), pair->second.end());
      }
    }
    hangs[order[n]] = !corners.empty() && on_a_line(corners);
  }
  std::size_t dropped = 0;
  for (std::size_t p = 0; p < hangs.size(); ++p) {
    dropped += hangs[p] ? parts.size(p) : 0;
    if (hangs[p] && static_cast<double>(parts.size(p)) > kSmallPart * static_cast<double>(all)) {
      throw InputError(fmt::format(
          "a part of {} of the {} voxels hangs on the others by an edge or a corner, as "
          "on a hinge; choose another resolution",
          parts.size(p), all));
    }
  }
  for (std::size_t v = 0; v < solid.labels.size(); ++v) {
    if (solid.labels[v] == VoxelLabel::kInside && hangs[parts.of_voxel(v)]) {
      solid.labels[v] = VoxelLabel::kOutside;
    }
  }
  return dropped;
}

}  // namespace haptrial::geometry
