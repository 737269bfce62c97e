#include "core/bone/surface/surface.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/growth.h"

namespace haptrial::bone {
namespace {

constexpr int kNone = -1;
constexpr int kVoxelReach = CellField::kReach + 1;  // how far, in cells, a quad follows a voxel

constexpr std::uint8_t kTessellate = 1;
constexpr std::uint8_t kNear = 2;

/// The brick that a cell lies in; cells -8 .. -1 are in brick -1.
Voxel brick_of(const Voxel& cell) { return {cell.x() >> 3, cell.y() >> 3, cell.z() >> 3}; }

std::size_t place_in_brick(const Voxel& cell) {
  return static_cast<std::size_t>(
      (cell.x() & 7) + BoneVolume::kEdge * ((cell.y() & 7) + BoneVolume::kEdge * (cell.z() & 7)));
}

Voxel corner(int b) { return {b & 1, b >> 1 & 1, b >> 2}; }

/// The filled corner that is nearest to a vertex.
std::uint8_t nearest_corner(unsigned corners, const Eigen::Vector3f& offset) {
  int nearest = 0;
  float least = 100.0F;
  for (int b = 0; b < 8; ++b) {
    const float squared =
        (corner(b).cast<float>() - Eigen::Vector3f::Constant(0.5F) - offset).squaredNorm();
    if ((corners >> b & 1U) != 0 && squared < least) {
      least = squared;
      nearest = b;
    }
  }
  return static_cast<std::uint8_t>(nearest);
}

}  // namespace

Surface::Surface(std::shared_ptr<const StructureDepths> depths) : near_(std::move(depths)) {}

bool Surface::update(const BoneVolume& volume) {
  if (!built()) {
    build(volume);
  }
  const bool first = !std::exchange(reported_, true);
  changed_voxels_.clear();
  worn_voxels_.clear();
  changed_bricks_.clear();
  if (!first) {
    forget_changes();
  }
  occupancy_.follow(volume, changed_voxels_, &changed_bricks_);
  remains_.follow(volume, occupancy_, changed_bricks_, &worn_voxels_);
  for (const Voxel& voxel : worn_voxels_) {
    mark(voxel);
  }
  for (const Voxel& voxel : changed_voxels_) {
    mark(voxel);
    if (near_.shows(volume, voxel)) {
      near_.lose();
    }
  }
  for (const std::size_t place : marked_) {
    place_vertices(volume, place);
  }
  for (const std::size_t place : marked_) {
    place_quads(place);
  }
  for (const Voxel& voxel : changed_voxels_) {
    mark_near(volume, voxel);
  }
  for (const std::size_t place : near_marked_) {
    refresh_near(volume, place);
  }
  for (const std::size_t place : marked_) {
    marks_[place] = 0;
    if (bricks_[place] != nullptr && bricks_[place]->living == 0) {
      bricks_[place].reset();
    }
  }
  for (const std::size_t place : near_marked_) {
    marks_[place] = 0;
  }
  constexpr std::size_t kFew = 4096;  // slots that are not worth packing
  if (free_vertices_.size() > std::max(vertices_.size() / 2, kFew)) {
    order_for_the_vertex_cache();
  }
  return rebuilt_ || !changed_vertices_.empty() || !changed_quads_.empty();
}

void Surface::begin(const BoneVolume& volume) {
  grid_ = volume.grid();
  std::size_t places = 1;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    table_size_[axis] =
        (grid_.size[axis] + BoneVolume::kEdge - 1) / BoneVolume::kEdge + 1;  // and brick -1
    places *= static_cast<std::size_t>(table_size_[axis]);
  }
  bricks_.resize(places);
  marks_.assign(places, 0);
  near_.begin(volume, occupancy_);
  border_ = BorderShares(volume);
  mix_ = LabelMix(volume);
}

void Surface::forget_changes() {
  for (const std::int32_t vertex : changed_vertices_) {
    vertex_touched_[static_cast<std::size_t>(vertex)] = 0;
  }
  for (const std::int32_t quad : changed_quads_) {
    quad_touched_[static_cast<std::size_t>(quad)] = 0;
  }
  changed_vertices_.clear();
  changed_quads_.clear();
  marked_.clear();
  near_marked_.clear();
  if (std::exchange(rebuilt_, false)) {
    changed_vertices_.shrink_to_fit();
    changed_quads_.shrink_to_fit();
  }
}

std::size_t Surface::place_of(const Voxel& brick) const noexcept {
  const Voxel at = brick + Voxel::Ones();
  return static_cast<std::size_t>(at.x()) +
         static_cast<std::size_t>(table_size_[0]) *
             (static_cast<std::size_t>(at.y()) +
              static_cast<std::size_t>(table_size_[1]) * static_cast<std::size_t>(at.z()));
}

Voxel Surface::brick_at(std::size_t place) const noexcept {
  const auto x = static_cast<std::size_t>(table_size_[0]);
  const auto y = static_cast<std::size_t>(table_size_[1]);
  return Voxel(static_cast<int>(place % x), static_cast<int>(place / x % y),
               static_cast<int>(place / (x * y))) -
         Voxel::Ones();
}

void Surface::mark_box(const Voxel& low, const Voxel& high, std::uint8_t flag,
                       std::vector<std::size_t>& list) {
  const Voxel last(table_size_[0] - 2, table_size_[1] - 2, table_size_[2] - 2);
  const Voxel from = brick_of(low).cwiseMax(-1);
  const Voxel to = brick_of(high).cwiseMin(last);
  for (int k = from.z(); k <= to.z(); ++k) {
    for (int j = from.y(); j <= to.y(); ++j) {
      for (int i = from.x(); i <= to.x(); ++i) {
        const std::size_t place = place_of({i, j, k});
        if ((marks_[place] & (kTessellate | flag)) == 0) {  // a new vertex has it all already
          marks_[place] |= flag;
          list.push_back(place);
        }
      }
    }
  }
}

void Surface::mark(const Voxel& voxel) {
  const Voxel reach = Voxel::Constant(kVoxelReach);
  mark_box(voxel - reach, voxel + reach, kTessellate, marked_);
}

void Surface::mark_near(const BoneVolume& volume, const Voxel& voxel) {
  if (near_.shows(volume, voxel)) {
    const Voxel reach = Voxel::Constant(near_.reach());
    mark_box(voxel - reach - Voxel::Ones(), voxel + reach, kNear, near_marked_);
  }
}

void Surface::place_vertices(const BoneVolume& volume, std::size_t place) {
  const Voxel origin = BoneVolume::kEdge * brick_at(place);
  std::unique_ptr<CellBrick>& brick = bricks_[place];
  const bool any = field_.read(volume, occupancy_, remains_, origin);
  if (!any && brick == nullptr) {
    return;
  }
  if (brick == nullptr) {
    brick = std::make_unique<CellBrick>();
    brick->vertices.fill(kNone);
  }
  bool mixed = false;
  if (any) {
    field_.smooth(remains_, border_);
    mixed = mix_.is_mixed(volume, origin);
  }
  std::size_t at = 0;
  for (int k = 0; k < BoneVolume::kEdge; ++k) {
    for (int j = 0; j < BoneVolume::kEdge; ++j) {
      for (int i = 0; i < BoneVolume::kEdge; ++i, ++at) {
        const unsigned corners = any ? field_.corners(i, j, k) : 0;
        if (corners == 0 || corners == 255) {
          remove_vertex(*brick, at);
        } else {
          const MadeVertex made = vertex_at(volume, origin, Voxel(i, j, k), field_, mixed);
          set_vertex(*brick, at, made.links, made.vertex);
        }
      }
    }
  }
}

Surface::MadeVertex Surface::vertex_at(const BoneVolume& volume, const Voxel& origin,
                                       const Voxel& of_brick, const CellField& field,
                                       bool mixed) const {
  const unsigned corners = field.corners(of_brick.x(), of_brick.y(), of_brick.z());
  const Voxel cell = origin + of_brick;
  Eigen::Vector3f normal;
  const Eigen::Vector3f offset =
      field.place(of_brick.x(), of_brick.y(), of_brick.z(), corners, normal);
  const std::uint8_t nearest = nearest_corner(corners, offset);
  SurfaceVertex vertex = make_vertex(volume, cell, corners, offset, normal, nearest);
  if (mixed) {
    const LabelMix::OtherLabel other =
        LabelMix::around(volume, field, origin, of_brick, vertex.label);
    vertex.other_label = other.label;
    vertex.other_share = other.share;
  }
  return {place_in_brick(of_brick),
          {{kNone, kNone, kNone},
           {static_cast<std::int16_t>(cell.x()), static_cast<std::int16_t>(cell.y()),
            static_cast<std::int16_t>(cell.z())},
           static_cast<std::uint8_t>(corners),
           nearest},
          vertex};
}

SurfaceVertex Surface::make_vertex(const BoneVolume& volume, const Voxel& cell, unsigned corners,
                                   const Eigen::Vector3f& offset, const Eigen::Vector3f& normal,
                                   std::uint8_t nearest) const {
  SurfaceVertex vertex;
  for (int axis = 0; axis < 3; ++axis) {
    const auto at = static_cast<std::size_t>(axis);
    const double middle = grid_.coordinate(axis, cell[axis]) + 0.5 * grid_.spacing;
    vertex.place[at] = static_cast<float>(middle + grid_.spacing * offset[axis]);
    vertex.normal[at] = static_cast<std::int16_t>(std::lround(32767.0F * normal[axis]));
  }
  const Voxel voxel = cell + corner(nearest);
  vertex.label = volume.label(voxel);
  vertex.density = mean_density(volume, cell, corners);
  set_near(volume, voxel, vertex);
  return vertex;
}

void Surface::set_near(const BoneVolume& volume, const Voxel& voxel, SurfaceVertex& vertex) const {
  const NearStructure near = near_.at(volume, occupancy_, voxel);
  vertex.near_label = near.label;
  vertex.near_depth = static_cast<std::uint8_t>(
      std::lround(std::min(near.distance / SurfaceVertex::kDepthUnit, 255.0)));
}

std::uint8_t Surface::mean_density(const BoneVolume& volume, const Voxel& cell, unsigned corners) {
  float sum = 0.0F;
  int count = 0;
  for (int b = 0; b < 8; ++b) {
    if ((corners >> b & 1U) != 0) {
      sum += volume.original(Voxel(cell + corner(b)));
      ++count;
    }
  }
  return static_cast<std::uint8_t>(std::lround(255.0F * sum / static_cast<float>(count)));
}

void Surface::set_vertex(CellBrick& brick, std::size_t at, const VertexLinks& links,
                         const SurfaceVertex& vertex) {
  std::int32_t& slot = brick.vertices[at];
  const bool fresh = slot == kNone;
  if (fresh) {
    ++brick.living;
    if (free_vertices_.empty()) {
      slot = static_cast<std::int32_t>(vertices_.size());
      resize_slowly(vertices_, vertices_.size() + 1);
      resize_slowly(links_, vertices_.size());
      resize_slowly(vertex_touched_, vertices_.size());
    } else {
      slot = free_vertices_.back();
      free_vertices_.pop_back();
    }
    links_[static_cast<std::size_t>(slot)] = links;
  }
  const auto index = static_cast<std::size_t>(slot);
  links_[index].corners = links.corners;
  links_[index].nearest = links.nearest;
  if (fresh || vertices_[index] != vertex) {
    vertices_[index] = vertex;
    touch_vertex(slot);
  }
}

void Surface::remove_vertex(CellBrick& brick, std::size_t at) {
  const std::int32_t slot = brick.vertices[at];
  if (slot == kNone) {
    return;
  }
  for (int axis = 0; axis < 3; ++axis) {
    remove_quad(slot, axis);
  }
  brick.vertices[at] = kNone;
  --brick.living;
  free_vertices_.push_back(slot);
}

template <class Visit>
void Surface::for_each_vertex(std::size_t place, const Visit& visit) {
  if (bricks_[place] == nullptr) {
    return;
  }
  for (const std::int32_t slot : bricks_[place]->vertices) {
    if (slot != kNone) {
      visit(slot);
    }
  }
}

void Surface::place_quads(std::size_t place) {
  for_each_vertex(place, [&](std::int32_t slot) {
    const VertexLinks& links = links_[static_cast<std::size_t>(slot)];
    for (int axis = 0; axis < 3; ++axis) {
      const bool here = (links.corners & 1U) != 0;
      const bool next = (links.corners >> (1 << axis) & 1U) != 0;
      if (here == next) {
        remove_quad(slot, axis);
      } else {
        set_quad(slot, axis, here);
      }
    }
  });
}

/// The triangles of a quad.
std::array<SurfaceTriangle, 2> Surface::halves(std::int32_t vertex, int axis, bool outwards) const {
  const Voxel cell = cell_of(vertex);
  const Voxel b = Voxel::Unit((axis + 1) % 3);
  const Voxel c = Voxel::Unit((axis + 2) % 3);
  // Anticlockwise seen from the far end of the axis.
  std::array<std::uint32_t, 4> ring{static_cast<std::uint32_t>(vertex),
                                    static_cast<std::uint32_t>(vertex_of(cell - b)),
                                    static_cast<std::uint32_t>(vertex_of(cell - b - c)),
                                    static_cast<std::uint32_t>(vertex_of(cell - c))};
  if (!outwards) {
    std::swap(ring[1], ring[3]);
  }
  const auto place = [&](std::size_t i) {
    return Eigen::Map<const Eigen::Vector3f>(vertices_[ring[i]].place.data());
  };
  const bool other_way = (place(1) - place(3)).squaredNorm() < (place(0) - place(2)).squaredNorm();
  const std::size_t first = other_way ? 1 : 0;
  return {SurfaceTriangle{ring[first], ring[first + 1], ring[first + 2]},
          SurfaceTriangle{ring[first], ring[first + 2], ring[(first + 3) % 4]}};
}

void Surface::set_quad(std::int32_t vertex, int axis, bool outwards) {
  const auto [one, two] = halves(vertex, axis, outwards);
  std::int32_t& slot =
      links_[static_cast<std::size_t>(vertex)].quads[static_cast<std::size_t>(axis)];
  bool changed = slot == kNone;
  if (changed) {
    if (free_quads_.empty()) {
      slot = static_cast<std::int32_t>(quad_touched_.size());
      resize_slowly(triangles_, triangles_.size() + 2);
      resize_slowly(quad_touched_, quad_touched_.size() + 1);
    } else {
      slot = free_quads_.back();
      free_quads_.pop_back();
    }
  }
  const auto at = 2 * static_cast<std::size_t>(slot);
  const auto touched = [&](const SurfaceTriangle& triangle) {
    return std::any_of(triangle.begin(), triangle.end(),
                       [&](std::uint32_t v) { return vertex_touched_[v] != 0; });
  };
  changed =
      changed || triangles_[at] != one || triangles_[at + 1] != two || touched(one) || touched(two);
  if (changed) {
    triangles_[at] = one;
    triangles_[at + 1] = two;
    touch_quad(slot);
  }
}

void Surface::remove_quad(std::int32_t vertex, int axis) {
  std::int32_t& slot =
      links_[static_cast<std::size_t>(vertex)].quads[static_cast<std::size_t>(axis)];
  if (slot == kNone) {
    return;
  }
  triangles_[2 * static_cast<std::size_t>(slot)] = {0, 0, 0};
  triangles_[2 * static_cast<std::size_t>(slot) + 1] = {0, 0, 0};
  touch_quad(slot);
  free_quads_.push_back(slot);
  slot = kNone;
}

void Surface::refresh_near(const BoneVolume& volume, std::size_t place) {
  for_each_vertex(place, [&](std::int32_t slot) {
    const auto index = static_cast<std::size_t>(slot);
    SurfaceVertex vertex = vertices_[index];
    set_near(volume, cell_of(slot) + corner(links_[index].nearest), vertex);
    if (vertex != vertices_[index]) {
      vertices_[index] = vertex;
      touch_vertex(slot);
    }
  });
}

void Surface::touch_vertex(std::int32_t vertex) {
  std::uint8_t& touched = vertex_touched_[static_cast<std::size_t>(vertex)];
  if (touched == 0) {
    touched = 1;
    changed_vertices_.push_back(vertex);
  }
}

void Surface::touch_quad(std::int32_t quad) {
  std::uint8_t& touched = quad_touched_[static_cast<std::size_t>(quad)];
  if (touched == 0) {
    touched = 1;
    changed_quads_.push_back(quad);
  }
}

std::int32_t Surface::vertex_of(const Voxel& cell) const noexcept {
  for (int axis = 0; axis < 3; ++axis) {
    if (cell[axis] < -1 || cell[axis] >= grid_.size[static_cast<std::size_t>(axis)]) {
      return kNone;
    }
  }
  if (bricks_.empty()) {
    return kNone;
  }
  const std::unique_ptr<CellBrick>& brick = bricks_[place_of(brick_of(cell))];
  return brick == nullptr ? kNone : brick->vertices[place_in_brick(cell)];
}

std::int32_t Surface::quad_of(const Voxel& voxel, int axis) const noexcept {
  const std::int32_t vertex = vertex_of(voxel);
  return vertex == kNone
             ? kNone
             : links_[static_cast<std::size_t>(vertex)].quads[static_cast<std::size_t>(axis)];
}

}  // namespace haptrial::bone
