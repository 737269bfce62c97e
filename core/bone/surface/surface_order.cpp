#include <meshoptimizer.h>

#include <algorithm>
#include <numeric>

#include "core/bone/surface/surface.h"

namespace haptrial::bone {

Surface::QuadOwner Surface::owner_of(const SurfaceTriangle& triangle) const noexcept {
  const Voxel& a = cell_of(static_cast<std::int32_t>(triangle[0]));
  const Voxel& b = cell_of(static_cast<std::int32_t>(triangle[1]));
  const Voxel& c = cell_of(static_cast<std::int32_t>(triangle[2]));
  // Three of the four cells around a pair of voxels: the first voxel's own is the farthest along
  // both axes across, and along the pair's axis they are the same.
  int axis = 0;
  while (a[axis] != b[axis] || a[axis] != c[axis]) {
    ++axis;
  }
  return {vertex_of(a.cwiseMax(b).cwiseMax(c)), axis};
}

/// Packs the slots and puts triangles that share vertices, and vertices that are used together,
/// one after the other.
void Surface::order_for_the_vertex_cache() {
  std::vector<SurfaceTriangle> living;
  living.reserve(triangle_count());
  for (const SurfaceTriangle& triangle : triangles_) {
    if (triangle[0] != triangle[1]) {
      living.push_back(triangle);
    }
  }
  std::vector<SurfaceTriangle> ordered(living.size());
  if (!living.empty()) {
    meshopt_optimizeVertexCache(ordered.front().data(), living.front().data(), 3 * living.size(),
                                vertices_.size());
  }
  living = {};
  constexpr std::uint32_t kUnseen = 0xFFFFFFFF;
  std::vector<std::uint32_t> new_vertex(vertices_.size(), kUnseen);
  std::vector<SurfaceVertex> vertices;
  std::vector<VertexLinks> links;
  vertices.reserve(vertex_count());
  links.reserve(vertex_count());
  const auto renumbered = [&](std::uint32_t old) {
    if (new_vertex[old] == kUnseen) {
      new_vertex[old] = static_cast<std::uint32_t>(vertices.size());
      vertices.push_back(vertices_[old]);
      links.push_back(links_[old]);
    }
    return new_vertex[old];
  };
  std::vector<SurfaceTriangle> triangles;
  triangles.reserve(living.size());
  std::vector<std::uint8_t> done(triangles_.size() / 2, 0);
  for (const SurfaceTriangle& triangle : ordered) {
    const auto [owner, axis] = owner_of(triangle);
    const std::int32_t quad =
        links_[static_cast<std::size_t>(owner)].quads[static_cast<std::size_t>(axis)];
    if (done[static_cast<std::size_t>(quad)] != 0) {
      continue;  // its other triangle came before
    }
    done[static_cast<std::size_t>(quad)] = 1;
    const auto number = static_cast<std::int32_t>(triangles.size() / 2);
    for (std::size_t half = 0; half < 2; ++half) {
      SurfaceTriangle t = triangles_[2 * static_cast<std::size_t>(quad) + half];
      std::transform(t.begin(), t.end(), t.begin(), renumbered);
      triangles.push_back(t);
    }
    links[new_vertex[static_cast<std::size_t>(owner)]].quads[static_cast<std::size_t>(axis)] =
        number;
  }
  for (const std::unique_ptr<CellBrick>& brick : bricks_) {
    if (brick != nullptr) {
      for (std::int32_t& slot : brick->vertices) {
        slot =
            slot < 0 ? slot : static_cast<std::int32_t>(new_vertex[static_cast<std::size_t>(slot)]);
      }
    }
  }
  vertices_ = std::move(vertices);
  links_ = std::move(links);
  triangles_ = std::move(triangles);
  free_vertices_.clear();
  free_quads_.clear();
  take_all_as_changed();
}

void Surface::take_all_as_changed() {
  vertex_touched_.assign(vertices_.size(), 1);
  quad_touched_.assign(triangles_.size() / 2, 1);
  changed_vertices_.resize(vertices_.size());
  changed_quads_.resize(triangles_.size() / 2);
  std::iota(changed_vertices_.begin(), changed_vertices_.end(), 0);
  std::iota(changed_quads_.begin(), changed_quads_.end(), 0);
  rebuilt_ = true;
}

}  // namespace haptrial::bone
