#include "core/geometry/voxelize.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "core/base/error.h"
#include "core/geometry/boundary_cone.h"
#include "core/geometry/flood_fill_internal.h"
#include "core/geometry/grid_crossings.h"
#include "core/geometry/mesh_edges_internal.h"

namespace haptrial::geometry {
namespace {

constexpr auto kOutside = VoxelLabel::kOutside;
constexpr auto kInside = VoxelLabel::kInside;
constexpr auto kBorder = VoxelLabel::kBorder;

bool is_closed(const Mesh& mesh) {
  const EdgeTable edges(mesh);
  for (std::size_t e = 0; e < edges.size(); ++e) {
    if (edges.sides(e).size() % 2 != 0) {
      return false;
    }
  }
  return edges.size() > 0;
}

/// Fills the runs between crossings for which `inside(number)` holds, where the number counts the
/// crossings so far (parity) or the windings.
template <class Inside>
void fill_rows(const GridCrossings& crossings, VoxelSolid& solid, const Inside& inside) {
  const auto length = static_cast<std::size_t>(solid.grid.size[0]);
  for (std::size_t line = 0; line < crossings.lines(); ++line) {
    VoxelLabel* row = solid.labels.data() + length * line;
    std::int32_t done = 0;
    int crossed = 0;
    int windings = 0;
    for (const Crossing& crossing : crossings.on_line(line)) {
      if (inside(crossed, windings)) {
        std::fill(row + done, row + crossing.before, kInside);
      }
      done = crossing.before;
      ++crossed;
      windings -= crossing.leaving;
    }
  }
}

void fill_by_parity(const Mesh& mesh, VoxelSolid& solid, const WorkReport& report) {
  const GridCrossings crossings(mesh, solid.grid, 0, report);
  fill_rows(crossings, solid, [](int crossed, int) { return crossed % 2 == 1; });
}

/// Corrects the labels near the cone of an open mesh, where it may decide.
class NearCone {
 public:
  NearCone(const Mesh& mesh, const Bvh* hierarchy, const BoundaryCone& cone, VoxelSolid& solid)
      : mesh_(mesh), hierarchy_(hierarchy), cone_(cone), solid_(solid), grid_(solid.grid) {}

  void run(const WorkReport& report) {
    const auto blocks = [&](int axis) { return (grid_.size[axis] + kBlock - 1) / kBlock; };
    for (std::int32_t k = 0; k < blocks(2); ++k) {
      report_share(report, static_cast<double>(k) / blocks(2));
      for (std::int32_t j = 0; j < blocks(1); ++j) {
        for (std::int32_t i = 0; i < blocks(0); ++i) {
          const Eigen::Array3i low = kBlock * Eigen::Array3i(i, j, k);
          const Eigen::Array3i size(grid_.size[0], grid_.size[1], grid_.size[2]);
          const Eigen::Array3i high = (low + kBlock).min(size) - 1;
          if (may_decide({grid_.centre(low.x(), low.y(), low.z()),
                          grid_.centre(high.x(), high.y(), high.z())})) {
            correct(low, high);
          }
        }
      }
    }
  }

 private:
  static constexpr std::int32_t kBlock = 8;

  /// A surface of area A, seen from a distance of d or more, fills at most A/d² of the 4π.
  bool may_decide(const Eigen::AlignedBox3d& box) const {
    double most = 0.0;
    for (const BoundaryCone::Fan& fan : cone_.fans) {
      const double distance = box.exteriorDistance(fan.middle) - fan.radius;
      if (distance <= 0.0) {
        return true;
      }
      most += fan.area / (4.0 * std::numbers::pi * distance * distance);
      if (most >= 0.49) {  // a little less than a half, for rounding
        return true;
      }
    }
    return false;
  }

  void correct(const Eigen::Array3i& low, const Eigen::Array3i& high) {
    for (std::int32_t k = low.z(); k <= high.z(); ++k) {
      for (std::int32_t j = low.y(); j <= high.y(); ++j) {
        for (std::int32_t i = low.x(); i <= high.x(); ++i) {
          const Eigen::Vector3d centre = grid_.centre(i, j, k);
          if (may_decide({centre, centre})) {
            VoxelLabel& label = solid_.labels[grid_.index(i, j, k)];
            label = is_inside(centre) ? kInside : kOutside;
          }
        }
      }
    }
  }

  bool is_inside(const Eigen::Vector3d& centre) {
    if (hierarchy_ == nullptr) {
      hierarchy_ = &own_.emplace(mesh_);
    }
    return hierarchy_->winds_around(centre);
  }

  const Mesh& mesh_;
  const Bvh* hierarchy_;
  const BoundaryCone& cone_;
  VoxelSolid& solid_;
  const VoxelGrid& grid_;
  std::optional<Bvh> own_;
};

void fill_by_winding(const Mesh& mesh, const Bvh* hierarchy, VoxelSolid& solid,
                     const WorkReport& report) {
  const BoundaryCone cone = boundary_cone(mesh);
  Mesh closed{cone.mesh.vertices, mesh.triangles};
  closed.triangles.insert(closed.triangles.end(), cone.mesh.triangles.begin(),
                          cone.mesh.triangles.end());
  {
    const GridCrossings crossings(closed, solid.grid, 0, report);
    fill_rows(crossings, solid, [](int, int windings) { return windings >= 1; });
  }
  NearCone(mesh, hierarchy, cone, solid).run(report);
}

/// Marks the outside voxels of a row that touch an inside one in it or in a row beside it.
void mark_row(const VoxelLabel* const (&beside)[4], VoxelLabel* row, std::int32_t length,
              std::vector<std::uint8_t>& touched) {
  std::fill(touched.begin(), touched.end(), std::uint8_t{0});
  for (const VoxelLabel* other : beside) {
    for (std::int32_t i = 0; other != nullptr && i < length; ++i) {
      touched[i] |= static_cast<std::uint8_t>(other[i] == kInside);
    }
  }
  for (std::int32_t i = 0; i + 1 < length; ++i) {
    touched[i] |= static_cast<std::uint8_t>(row[i + 1] == kInside);
    touched[i + 1] |= static_cast<std::uint8_t>(row[i] == kInside);
  }
  for (std::int32_t i = 0; i < length; ++i) {
    row[i] = row[i] == kOutside && touched[i] != 0 ? kBorder : row[i];
  }
}

void mark_border(VoxelSolid& solid) {
  const auto [length, rows, layers] = solid.grid.size;
  std::vector<std::uint8_t> touched(static_cast<std::size_t>(length));
  const auto row = [&](std::int32_t j, std::int32_t k) -> VoxelLabel* {
    const bool there = j >= 0 && j < rows && k >= 0 && k < layers;
    return there ? solid.labels.data() + solid.grid.index(0, j, k) : nullptr;
  };
  for (std::int32_t k = 0; k < layers; ++k) {
    for (std::int32_t j = 0; j < rows; ++j) {
      mark_row({row(j - 1, k), row(j + 1, k), row(j, k - 1), row(j, k + 1)}, row(j, k), length,
               touched);
    }
  }
}

}  // namespace

InsideRule fitting_rule(const Mesh& mesh) {
  return is_closed(mesh) ? InsideRule::kParity : InsideRule::kWinding;
}

VoxelSolid voxelize(const Mesh& mesh, const VoxelGrid& grid, InsideRule rule,
                    const WorkReport& report, const Bvh* hierarchy) {
  if (rule != InsideRule::kWinding && !is_closed(mesh)) {
    throw InputError(
        "the mesh is open, so parity and flood do not tell inside from outside; "
        "allowed: winding");
  }
  VoxelSolid solid{grid, std::vector<VoxelLabel>(grid.count(), kOutside)};
  switch (rule) {
    case InsideRule::kParity:
      fill_by_parity(mesh, solid, report);
      break;
    case InsideRule::kWinding:
      fill_by_winding(mesh, hierarchy, solid, report);
      break;
    case InsideRule::kFlood:
      flood_fill(mesh, solid, report);
      break;
  }
  mark_border(solid);
  return solid;
}

double voxelizing_memory(const Mesh& mesh, const VoxelGrid& grid, InsideRule rule) {
  const double labels = static_cast<double>(grid.count());
  const double crossings = crossing_memory(mesh, grid);
  // A flood keeps which neighbours are cut off, and where it has yet to go on; the cone at worst
  // triples the triangles.
  return rule == InsideRule::kFlood ? 2.0 * labels + 9.0 * labels + crossings
         : rule == InsideRule::kWinding
             ? labels + 4.0 * crossings + 400.0 * static_cast<double>(mesh.triangles.size())
             : labels + crossings;
}

void grow(VoxelSolid& solid) {
  std::replace(solid.labels.begin(), solid.labels.end(), kBorder, kInside);
  mark_border(solid);
}

std::size_t count_inside(const VoxelSolid& solid) {
  return static_cast<std::size_t>(std::count(solid.labels.begin(), solid.labels.end(), kInside));
}

}  // namespace haptrial::geometry
