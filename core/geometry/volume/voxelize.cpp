#include "core/geometry/volume/voxelize.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <span>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/geometry/mesh/mesh_edges.h"
#include "core/geometry/mesh/mesh_size.h"
#include "core/geometry/volume/boundary_cone.h"
#include "core/geometry/volume/flood_fill.h"
#include "core/geometry/volume/grid_crossings.h"
#include "core/geometry/volume/mesh_repair.h"

namespace haptrial::geometry {
namespace {

constexpr auto kOutside = VoxelLabel::kOutside;
constexpr auto kInside = VoxelLabel::kInside;
constexpr auto kBorder = VoxelLabel::kBorder;

/// Whether `holds(sides)` of every edge; a mesh without an edge fails.
template <class Holds>
bool every_edge(const Mesh& mesh, const Holds& holds) {
  const EdgeTable edges(mesh);
  for (std::size_t e = 0; e < edges.size(); ++e) {
    if (!holds(edges.sides(e))) {
      return false;
    }
  }
  return edges.size() > 0;
}

bool is_closed(const Mesh& mesh) {
  return every_edge(mesh, [](std::span<const Side> sides) { return sides.size() % 2 == 0; });
}

/// Whether every edge is run along as often one way as the other, so that windings are whole.
bool winds_whole(const Mesh& mesh) {
  return every_edge(mesh, [&](std::span<const Side> sides) {
    const auto forwards = std::ranges::count_if(
        sides, [&](Side side) { return start_of(mesh, side) == start_of(mesh, sides[0]); });
    return 2 * static_cast<std::size_t>(forwards) == sides.size();
  });
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

/// Corrects the labels near the cone of an open mesh: where it winds by a half or more.
class NearCone {
 public:
  /// @param crossings  of mesh and cone together
  NearCone(const BoundaryCone& cone, const GridCrossings& crossings, VoxelSolid& solid)
      : cone_(cone), crossings_(crossings), solid_(solid), grid_(solid.grid) {}

  void run(const WorkReport& report) {
    const Eigen::Array3i size(grid_.size[0], grid_.size[1], grid_.size[2]);
    for (std::int32_t k = 0; k < size.z(); k += kBlock) {
      report_share(report, static_cast<double>(k) / size.z());
      for (std::int32_t j = 0; j < size.y(); j += kBlock) {
        for (std::int32_t i = 0; i < size.x(); i += kBlock) {
          const Eigen::Array3i low(i, j, k);
          visit(low, (low + kBlock).min(size) - 1, kBlock / 2);
        }
      }
    }
  }

 private:
  static constexpr std::int32_t kBlock = 16;
  static constexpr std::int32_t kLeastBlock = 4;
  static constexpr double kHalf = 0.49;  // a little less than a half, for rounding

  /// Corrects the voxels from `low` to `high`, in halves as long as that may spare some.
  void visit(const Eigen::Array3i& low, const Eigen::Array3i& high, std::int32_t half) {
    if ((high < low).any() || !may_decide({grid_.centre(low.x(), low.y(), low.z()),
                                           grid_.centre(high.x(), high.y(), high.z())})) {
      return;
    }
    if (half < kLeastBlock) {
      correct(low, high);
      return;
    }
    for (int part = 0; part < 8; ++part) {
      const Eigen::Array3i from = low + half * Eigen::Array3i(part & 1, part >> 1 & 1, part >> 2);
      visit(from, (from + half - 1).min(high), half / 2);
    }
  }

  bool may_decide(const Eigen::AlignedBox3d& box) const {
    double most = 0.0;
    for (const BoundaryCone::Fan& fan : cone_.fans) {
      most += BoundaryCone::most_winding(fan, box.exteriorDistance(fan.middle));
      if (most >= kHalf) {
        return true;
      }
    }
    return false;
  }

  void correct(const Eigen::Array3i& low, const Eigen::Array3i& high) {
    gather_near(
        {grid_.centre(low.x(), low.y(), low.z()), grid_.centre(high.x(), high.y(), high.z())});
    std::vector<Eigen::Array3i> batch;
    for (std::int32_t k = low.z(); k <= high.z(); ++k) {
      for (std::int32_t j = low.y(); j <= high.y(); ++j) {
        for (std::int32_t i = low.x(); i <= high.x(); ++i) {
          batch.emplace_back(i, j, k);
          if (batch.size() == kPointLanes) {
            correct(batch);
            batch.clear();
          }
        }
      }
    }
    correct(batch);
  }

  /// The fans near a box as triangles in voxels around its middle; the others as a bound.
  void gather_near(const Eigen::AlignedBox3d& box) {
    constexpr double kSmall = 0.01;
    middle_ = box.center();
    near_.clear();
    far_ = 0.0;
    for (const BoundaryCone::Fan& fan : cone_.fans) {
      const double most = BoundaryCone::most_winding(fan, box.exteriorDistance(fan.middle));
      if (far_ + most < kSmall) {
        far_ += most;
        continue;
      }
      for (std::size_t t = fan.first; t < fan.first + fan.count; ++t) {
        for (const std::int32_t corner : cone_.mesh.triangles[t]) {
          near_.push_back(in_block(cone_.mesh.vertices[corner]));
        }
      }
    }
  }

  Eigen::Vector3f in_block(const Eigen::Vector3d& point) const {
    return ((point - middle_) / grid_.spacing).cast<float>();
  }

  void correct(const std::vector<Eigen::Array3i>& voxels) {
    constexpr double kDoubt = 1e-3;  // many times what the sums may be wrong by
    PointLanes points{};
    std::array<float, kPointLanes> sums{};
    for (std::size_t v = 0; v < voxels.size(); ++v) {
      const Eigen::Vector3f at =
          in_block(grid_.centre(voxels[v].x(), voxels[v].y(), voxels[v].z()));
      points.x[v] = at.x();
      points.y[v] = at.y();
      points.z[v] = at.z();
    }
    winding_sums(near_, points, sums);
    for (std::size_t v = 0; v < voxels.size(); ++v) {
      if (std::abs(sums[v]) + far_ < kHalf) {
        continue;
      }
      const auto [i, j, k] = std::array{voxels[v].x(), voxels[v].y(), voxels[v].z()};
      double of_cone = sums[v];
      if (std::abs(windings(i, j, k) - of_cone - 0.5) <= far_ + kDoubt) {
        of_cone = winding_sum(cone_.mesh, grid_.centre(i, j, k));
      }
      const bool inside = windings(i, j, k) - of_cone > 0.5;
      solid_.labels[grid_.index(i, j, k)] = inside ? kInside : kOutside;
    }
  }

  /// How often mesh and cone together wind around a voxel's centre.
  int windings(std::int32_t i, std::int32_t j, std::int32_t k) const {
    int count = 0;
    for (const Crossing& crossing :
         crossings_.on_line(grid_.index(0, j, k) / static_cast<std::size_t>(grid_.size[0]))) {
      count -= crossing.before <= i ? crossing.leaving : 0;
    }
    return count;
  }

  const BoundaryCone& cone_;
  const GridCrossings& crossings_;
  VoxelSolid& solid_;
  const VoxelGrid& grid_;
  Eigen::Vector3d middle_{Eigen::Vector3d::Zero()};  // of the block at hand [m]
  std::vector<Eigen::Vector3f> near_;                // corners of the near fans' triangles [voxels]
  double far_{0.0};                                  // a bound on the winding of the others
};

/// Voxel by voxel, for meshes whose boundary is no small part of them.
void fill_by_hierarchy(const Bvh& hierarchy, VoxelSolid& solid, const WorkReport& report) {
  const VoxelGrid& grid = solid.grid;
  for (std::int32_t k = 0; k < grid.size[2]; ++k) {
    report_share(report, static_cast<double>(k) / grid.size[2]);
    parallel_for(static_cast<std::size_t>(grid.size[1]), 0, [&](std::size_t row) {
      const auto j = static_cast<std::int32_t>(row);
      for (std::int32_t i = 0; i < grid.size[0]; ++i) {
        if (hierarchy.winds_around(grid.centre(i, j, k))) {
          solid.labels[grid.index(i, j, k)] = kInside;
        }
      }
    });
  }
}

bool is_small(const BoundaryCone& cone) {
  constexpr std::size_t kFewFans = 20000;
  constexpr std::size_t kFewTriangles = 200000;
  return cone.fans.size() <= kFewFans && cone.mesh.triangles.size() <= kFewTriangles;
}

Mesh turned(Mesh mesh) {
  for (Triangle& triangle : mesh.triangles) {
    std::swap(triangle[1], triangle[2]);
  }
  return mesh;
}

void fill_by_winding(const Mesh& mesh, const Bvh* hierarchy, VoxelSolid& solid,
                     const WorkReport& report) {
  BoundaryCone cone = boundary_cone(mesh);
  if (!is_small(cone)) {  // perhaps only because neighbours do not share their vertices
    Mesh welded = mesh;
    weld(welded, 0.0);
    cone = boundary_cone(welded);
  }
  if (!cone.fans.empty() && signed_volume(mesh) < 0.0) {  // faces of an open mesh look inwards
    fill_by_winding(turned(mesh), nullptr, solid, report);
    return;
  }
  if (!is_small(cone)) {
    hierarchy != nullptr ? fill_by_hierarchy(*hierarchy, solid, report)
                         : fill_by_hierarchy(Bvh(mesh), solid, report);
    return;
  }
  if (cone.fans.empty()) {
    const GridCrossings crossings(mesh, solid.grid, 0, report);
    fill_rows(crossings, solid, [](int, int windings) { return windings != 0; });
    return;
  }
  Mesh closed = mesh;
  const auto moved = static_cast<std::int32_t>(mesh.vertices.size());
  closed.vertices.insert(closed.vertices.end(), cone.mesh.vertices.begin(),
                         cone.mesh.vertices.end());
  for (const Triangle& t : cone.mesh.triangles) {
    closed.triangles.push_back({t[0] + moved, t[1] + moved, t[2] + moved});
  }
  const GridCrossings crossings(closed, solid.grid, 0, report);
  fill_rows(crossings, solid, [](int, int windings) { return windings >= 1; });
  NearCone(cone, crossings, solid).run(report);
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
  return is_closed(mesh) && !winds_whole(mesh) ? InsideRule::kParity : InsideRule::kWinding;
}

VoxelSolid voxelize(const Mesh& mesh, const VoxelGrid& grid, InsideRule rule,
                    const WorkReport& report, const Bvh* hierarchy) {
  if (rule != InsideRule::kWinding && !is_closed(mesh)) {
    throw InputError(
        "the mesh is open, so the rules parity and flood cannot tell inside from outside; choose "
        "the rule winding");
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
  // A flood keeps which neighbours are cut off, and where it has yet to go on. A small cone adds
  // crossings of its own; a hierarchy takes the place of the crossings where it is large.
  return rule == InsideRule::kFlood ? 2.0 * labels + 9.0 * labels + crossings
         : rule == InsideRule::kWinding && !winds_whole(mesh)
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
