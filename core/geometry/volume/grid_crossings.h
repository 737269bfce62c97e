#pragma once

#include <cstdint>
#include <vector>

#include "core/geometry/mesh/mesh.h"
#include "core/geometry/mesh/work.h"
#include "core/geometry/volume/voxel_grid.h"

namespace haptrial::geometry {

/// A grid line (through voxel centres, along an axis) that a triangle crosses.
struct Crossing {
  std::uint32_t line;    // u + size_u v, where u and v are the voxel's numbers along the next axes
  std::int32_t before;   // how many of the line's centres lie before the crossing, 0 .. size
  std::int32_t leaving;  // 1: along the triangle's normal, so out of a solid; -1: against it
};

/// The crossings of all grid lines along `axis` with a mesh, sorted by line and then by place; what
/// a ray from every voxel centre to its neighbour would find, found triangle by triangle instead.
///
/// Exact: a centre that lies on a triangle, or a line that meets an edge, counts as if the whole
/// grid were shifted by (e, e², e³) with an e above 0 as small as need be, the same for all axes.
/// So lines cross a closed mesh an even number of times, and what one axis says of a centre all
/// say. Source: Morris 2006, §5.2.2 (which neighbours of a voxel lie across the surface).
class GridCrossings {
 public:
  GridCrossings(const Mesh& mesh, const VoxelGrid& grid, int axis, const WorkReport& report = {});

  struct Range {
    const Crossing* first;
    const Crossing* last;
    const Crossing* begin() const { return first; }
    const Crossing* end() const { return last; }
  };
  Range on_line(std::size_t line) const {
    return {crossings_.data() + begin_[line], crossings_.data() + begin_[line + 1]};
  }
  std::size_t lines() const { return begin_.size() - 1; }
  std::size_t count() const { return crossings_.size(); }

 private:
  std::vector<Crossing> crossings_;
  std::vector<std::uint64_t> begin_;  // of each line in crossings_, and the end
};

/// A bound on what GridCrossings takes while it is made [bytes].
double crossing_memory(const Mesh& mesh, const VoxelGrid& grid);

}  // namespace haptrial::geometry
