#include <algorithm>
#include <atomic>
#include <numeric>
#include <utility>

#include "core/base/parallel.h"
#include "core/bone/surface/surface.h"

namespace haptrial::bone {
namespace {

constexpr std::size_t kBatch = 4096;  // bricks of cells between two reports
constexpr std::size_t kGroup = 64;    // of them that a thread takes at once
// Shares of the time that it takes.
constexpr double kUntilVertices = 0.7;
constexpr double kUntilQuads = 0.9;

}  // namespace

void Surface::build(const BoneVolume& volume, const geometry::WorkReport& report) {
  occupancy_.follow(volume);
  begin(volume);
  changed_bricks_.resize(static_cast<std::size_t>(volume.bricks()) - 1);
  std::iota(changed_bricks_.begin(), changed_bricks_.end(), 1);
  remains_.follow(volume, occupancy_, changed_bricks_, nullptr);
  begin_places(volume);
  const std::vector<std::size_t> places = std::exchange(marked_, {});
  const int threads = threads_or_all(0);
  make_room(volume, places, threads);
  /// Makes batch by batch in parallel, and keeps in order.
  const auto in_batches = [&](auto made, double from, double to, const auto& make,
                              const auto& keep) {
    for (std::size_t first = 0; first < places.size(); first += kBatch) {
      const std::size_t count = std::min(kBatch, places.size() - first);
      made.resize(count);
      in_groups(count, kGroup, threads, [&] {
        return [&, field = CellField()](std::size_t begin, std::size_t some) mutable {
          for (std::size_t n = begin; n < begin + some; ++n) {
            made[n].clear();
            make(places[first + n], field, made[n]);
          }
        };
      });
      for (std::size_t n = 0; n < count; ++n) {
        keep(places[first + n], made[n]);
      }
      const double share = static_cast<double>(first + count) / static_cast<double>(places.size());
      geometry::report_share(report, from + (to - from) * share);
    }
  };
  in_batches(
      std::vector<std::vector<MadeVertex>>(), 0.0, kUntilVertices,
      [&](std::size_t place, CellField& field, std::vector<MadeVertex>& made) {
        make_vertices(volume, place, field, made);
      },
      [&](std::size_t place, const std::vector<MadeVertex>& made) { keep_vertices(place, made); });
  in_batches(
      std::vector<std::vector<MadeQuad>>(), kUntilVertices, kUntilQuads,
      [&](std::size_t place, CellField&, std::vector<MadeQuad>& made) { make_quads(place, made); },
      [&](std::size_t, const std::vector<MadeQuad>& made) {
        for (const MadeQuad& quad : made) {
          links_[static_cast<std::size_t>(quad.vertex)].quads[static_cast<std::size_t>(quad.axis)] =
              static_cast<std::int32_t>(triangles_.size() / 2);
          triangles_.insert(triangles_.end(), quad.triangles.begin(), quad.triangles.end());
        }
      });
  // Bricks are an order that caches can live with; a better one takes a surface's size once more.
  constexpr std::size_t kMostOrdered = 4'000'000;  // triangles
  if (triangles_.size() <= kMostOrdered) {
    order_for_the_vertex_cache();
  } else {
    take_all_as_changed();
  }
  geometry::report_share(report, 1.0);
}

/// All bricks of cells that may have vertices.
void Surface::begin_places(const BoneVolume& volume) {
  for (std::int32_t brick = 1; brick < volume.bricks(); ++brick) {
    const Voxel& origin = volume.brick_origin(brick);
    mark_box(origin - Voxel::Ones(), origin + Voxel::Constant(BoneVolume::kEdge - 1), 1, marked_);
  }
  for (const std::size_t place : marked_) {
    marks_[place] = 0;
  }
}

/// Makes room for all vertices and quads, which are counted first: growing arrays would take up to
/// three times the memory.
void Surface::make_room(const BoneVolume& volume, const std::vector<std::size_t>& places,
                        int threads) {
  std::atomic<std::size_t> vertices{0};
  std::atomic<std::size_t> quads{0};
  in_groups(places.size(), kGroup, threads, [&] {
    return [&, field = CellField()](std::size_t begin, std::size_t some) mutable {
      for (std::size_t n = begin; n < begin + some; ++n) {
        if (field.read(volume, occupancy_, remains_, BoneVolume::kEdge * brick_at(places[n]))) {
          const CellField::Count count = field.count();
          vertices += count.vertices;
          quads += count.quads;
        }
      }
    };
  });
  vertices_.reserve(vertices);
  links_.reserve(vertices);
  triangles_.reserve(2 * quads);
}

void Surface::make_vertices(const BoneVolume& volume, std::size_t place, CellField& field,
                            std::vector<MadeVertex>& made) const {
  const Voxel origin = BoneVolume::kEdge * brick_at(place);
  if (!field.read(volume, occupancy_, remains_, origin)) {
    return;
  }
  field.smooth(remains_, border_);
  const bool mixed = mix_.is_mixed(volume, origin);
  for (int k = 0; k < BoneVolume::kEdge; ++k) {
    for (int j = 0; j < BoneVolume::kEdge; ++j) {
      for (int i = 0; i < BoneVolume::kEdge; ++i) {
        const unsigned corners = field.corners(i, j, k);
        if (corners != 0 && corners != 255) {
          made.push_back(vertex_at(volume, origin, Voxel(i, j, k), field, mixed));
        }
      }
    }
  }
}

void Surface::keep_vertices(std::size_t place, const std::vector<MadeVertex>& made) {
  if (made.empty()) {
    return;
  }
  std::unique_ptr<CellBrick>& brick = bricks_[place];
  brick = std::make_unique<CellBrick>();
  brick->vertices.fill(-1);
  brick->living = static_cast<std::int32_t>(made.size());
  for (const MadeVertex& one : made) {
    brick->vertices[one.at] = static_cast<std::int32_t>(vertices_.size());
    vertices_.push_back(one.vertex);
    links_.push_back(one.links);
  }
}

void Surface::make_quads(std::size_t place, std::vector<MadeQuad>& made) const {
  if (bricks_[place] == nullptr) {
    return;
  }
  for (const std::int32_t slot : bricks_[place]->vertices) {
    if (slot < 0) {
      continue;
    }
    const unsigned corners = links_[static_cast<std::size_t>(slot)].corners;
    for (int axis = 0; axis < 3; ++axis) {
      const bool here = (corners & 1U) != 0;
      if (here != ((corners >> (1 << axis) & 1U) != 0)) {
        made.push_back({slot, axis, halves(slot, axis, here)});
      }
    }
  }
}

}  // namespace haptrial::bone
