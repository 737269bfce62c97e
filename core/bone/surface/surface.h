#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/bone/model/bone_volume.h"
#include "core/bone/model/occupancy.h"
#include "core/bone/surface/border_shares.h"
#include "core/bone/surface/near_structures.h"
#include "core/bone/surface/remains.h"
#include "core/bone/surface/surface_cells.h"
#include "core/bone/surface/surface_depths.h"
#include "core/geometry/mesh/work.h"

namespace haptrial::bone {

/// The surface of a bone as triangles that follow what is removed and put back.
///
/// A cell is the cube between the centres of eight voxels; cell (i, j, k) lies between voxel
/// (i, j, k) and (i + 1, j + 1, k + 1), so that cells run from -1 to the grid's size less one. Each
/// cell with both filled and empty corners has one vertex; each pair of neighbouring voxels of
/// which one is filled has one quad, of the vertices of the four cells around the pair, as two
/// triangles that run anticlockwise seen from outside. Every edge is therefore closed: it is
/// shared by as many triangles one way as the other. All of a vertex and a quad follows from the
/// voxels at most 4 from the cells, but for the structure that shows through, which follows from
/// those in its reach: a local update gives what a full one gives, to the bit.
///
/// Vertices and quads keep their slots while they live; slots of dead ones are used again.
/// One thread, any; it may run while the servo thread changes the volume.
/// Source: Morris 2006, §3.2.2 and §3.2.4 (one vertex to a surface voxel, triangles found from the
/// voxel and back); the dual method in its place:
/// docs/decisions/0010-one-vertex-per-surface-cell.md.
class Surface {
 public:
  /// @param depths  for what shows through; may be null.
  explicit Surface(std::shared_ptr<const StructureDepths> depths = nullptr);

  /// The whole surface, on as many threads as the machine has processors: seconds for a large bone,
  /// so that it can be built before it is shown. Instead of the first update(), which calls it.
  /// @param report  on the calling thread. @throws geometry::Cancelled where it asks to stop
  void build(const BoneVolume& volume, const geometry::WorkReport& report = {});
  bool built() const noexcept { return !bricks_.empty(); }

  /// Follows the volume, always the same one: retessellates around voxels that were filled or
  /// emptied, or of which a sixteenth more was taken. The first call builds the whole and orders
  /// it for the vertex cache; so does one that leaves most slots dead, which gives them back. The
  /// first one after build() reports all as changed.
  /// @returns whether anything changed.
  bool update(const BoneVolume& volume);

  /// Vertices by slot. A dead vertex keeps its last values.
  std::span<const SurfaceVertex> vertices() const noexcept { return vertices_; }
  /// Triangles 2q and 2q + 1 are quad q; those of a dead quad have three equal corners.
  std::span<const SurfaceTriangle> triangles() const noexcept { return triangles_; }
  std::size_t vertex_count() const noexcept { return vertices_.size() - free_vertices_.size(); }
  std::size_t triangle_count() const noexcept { return triangles_.size() - 2 * free_quads_.size(); }

  /// The slot of a cell's vertex; -1 where it has none.
  std::int32_t vertex_of(const Voxel& cell) const noexcept;
  /// The cell of a living vertex.
  Voxel cell_of(std::int32_t vertex) const noexcept {
    const auto& [i, j, k] = links_[static_cast<std::size_t>(vertex)].cell;
    return {i, j, k};
  }
  /// The quad between a voxel and the next along an axis (0, 1, 2); -1 where there is none. A
  /// triangle t belongs to quad t / 2.
  std::int32_t quad_of(const Voxel& voxel, int axis) const noexcept;

  /// Slots that the last update() changed, each once, in no order; all where it
  /// gave out the slots anew. A quad also counts where a vertex of it moved or turned.
  std::span<const std::int32_t> changed_vertices() const noexcept { return changed_vertices_; }
  std::span<const std::int32_t> changed_quads() const noexcept { return changed_quads_; }
  /// Whether the last update() gave out all slots anew.
  bool rebuilt() const noexcept { return rebuilt_; }

 private:
  struct VertexLinks {
    std::array<std::int32_t, 3> quads;  // of the pairs from the cell's first voxel along each axis
    std::array<std::int16_t, 3> cell;   // a grid has at most 32,767 voxels along an axis
    std::uint8_t corners;               // bit b: CellField::corners
    std::uint8_t nearest;               // corner: the filled one that is nearest to the vertex
  };
  struct CellBrick {
    std::array<std::int32_t, BoneVolume::kBrickVoxels> vertices;  // -1: none
    std::int32_t living{0};
  };
  struct QuadOwner {
    std::int32_t vertex;
    int axis;
  };

  struct MadeVertex {
    std::size_t at;  // in its brick
    VertexLinks links;
    SurfaceVertex vertex;
  };
  struct MadeQuad {
    std::int32_t vertex;
    int axis;
    std::array<SurfaceTriangle, 2> triangles;
  };

  void begin(const BoneVolume& volume);
  void begin_places(const BoneVolume& volume);
  void make_room(const BoneVolume& volume, const std::vector<std::size_t>& places, int threads);
  void make_vertices(const BoneVolume& volume, std::size_t place, CellField& field,
                     std::vector<MadeVertex>& made) const;
  void keep_vertices(std::size_t place, const std::vector<MadeVertex>& made);
  void make_quads(std::size_t place, std::vector<MadeQuad>& made) const;
  std::array<SurfaceTriangle, 2> halves(std::int32_t vertex, int axis, bool outwards) const;
  void forget_changes();
  std::size_t place_of(const Voxel& brick) const noexcept;
  Voxel brick_at(std::size_t place) const noexcept;
  void mark_box(const Voxel& low, const Voxel& high, std::uint8_t flag,
                std::vector<std::size_t>& list);
  void mark(const Voxel& voxel);
  void mark_near(const BoneVolume& volume, const Voxel& voxel);

  void place_vertices(const BoneVolume& volume, std::size_t place);
  MadeVertex vertex_at(const BoneVolume& volume, const Voxel& origin, const Voxel& of_brick,
                       const CellField& field, bool mixed) const;
  SurfaceVertex make_vertex(const BoneVolume& volume, const Voxel& cell, unsigned corners,
                            const Eigen::Vector3f& offset, const Eigen::Vector3f& normal,
                            std::uint8_t nearest) const;
  void set_near(const BoneVolume& volume, const Voxel& voxel, SurfaceVertex& vertex) const;
  static std::uint8_t mean_density(const BoneVolume& volume, const Voxel& cell, unsigned corners);
  void set_vertex(CellBrick& brick, std::size_t at, const VertexLinks& links,
                  const SurfaceVertex& vertex);
  void remove_vertex(CellBrick& brick, std::size_t at);
  template <class Visit>
  void for_each_vertex(std::size_t place, const Visit& visit);
  void place_quads(std::size_t place);
  void set_quad(std::int32_t vertex, int axis, bool outwards);
  void remove_quad(std::int32_t vertex, int axis);
  void refresh_near(const BoneVolume& volume, std::size_t place);
  void touch_vertex(std::int32_t vertex);
  void touch_quad(std::int32_t quad);

  QuadOwner owner_of(const SurfaceTriangle& triangle) const noexcept;
  void order_for_the_vertex_cache();
  void take_all_as_changed();

  NearStructures near_;
  Occupancy occupancy_;
  RemainingFraction remains_;
  BorderShares border_;
  LabelMix mix_;
  geometry::VoxelGrid grid_;
  std::array<std::int32_t, 3> table_size_{0, 0, 0};  // in bricks of cells
  std::vector<std::unique_ptr<CellBrick>> bricks_;   // by place; null: no vertex there
  std::vector<SurfaceVertex> vertices_;
  std::vector<VertexLinks> links_;  // by vertex
  std::vector<SurfaceTriangle> triangles_;
  std::vector<std::int32_t> free_vertices_;
  std::vector<std::int32_t> free_quads_;

  // Field of the update at hand; kept for its memory.
  CellField field_;
  std::vector<Voxel> changed_voxels_;  // filled or emptied
  std::vector<Voxel> worn_voxels_;     // of which more or less is left
  std::vector<std::int32_t> changed_bricks_;
  std::vector<std::uint8_t> marks_;       // by place
  std::vector<std::size_t> marked_;       // places to be tessellated again
  std::vector<std::size_t> near_marked_;  // places where something else may show through
  std::vector<std::uint8_t> vertex_touched_;
  std::vector<std::uint8_t> quad_touched_;
  std::vector<std::int32_t> changed_vertices_;
  std::vector<std::int32_t> changed_quads_;
  bool rebuilt_{false};
  bool reported_{false};  // an update() has said that all is new
};

}  // namespace haptrial::bone
