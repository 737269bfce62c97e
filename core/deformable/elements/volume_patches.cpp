#include "core/deformable/elements/volume_patches.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "core/base/error.h"

namespace haptrial::deformable {
namespace {

using geometry::Tetrahedron;
using Neighbours = std::vector<std::array<std::int32_t, 4>>;  // -1: none

constexpr std::size_t kCube = 5;   // tetrahedra
constexpr std::size_t kGrown = 6;  // about as many tetrahedra as a mesh has for each vertex
constexpr std::size_t kAlone = 3;  // a smaller patch joins a neighbour

std::uint8_t material(std::span<const std::uint8_t> of, std::size_t tet) {
  return of.empty() ? std::uint8_t{0} : of[tet];
}

/// Whether the five from `first` on are a middle one and one on each of its faces.
bool are_a_cube(std::span<const Tetrahedron> five) {
  std::array<std::int32_t, 4 * kCube> corners{};
  for (std::size_t i = 0; i < kCube; ++i) {
    std::copy(five[i].begin(), five[i].end(), corners.begin() + static_cast<long>(4 * i));
  }
  std::sort(corners.begin(), corners.end());
  std::array<int, 5> shared{};  // [k]: vertices that k corners name
  for (auto at = corners.begin(); at != corners.end();) {
    const auto next = std::upper_bound(at, corners.end(), *at);
    if (next - at > 4) {
      return false;
    }
    ++shared[static_cast<std::size_t>(next - at)];
    at = next;
  }
  return shared[4] == 4 && shared[1] == 4;  // the middle's corners are in four, the others in one
}

bool all_are_cubes(std::span<const Tetrahedron> tetrahedra, std::span<const std::uint8_t> of) {
  if (tetrahedra.size() % kCube != 0) {
    return false;
  }
  for (std::size_t first = 0; first < tetrahedra.size(); first += kCube) {
    for (std::size_t i = 1; i < kCube; ++i) {
      if (material(of, first + i) != material(of, first)) {
        return false;
      }
    }
    if (!are_a_cube(tetrahedra.subspan(first, kCube))) {
      return false;
    }
  }
  return true;
}

/// A tetrahedron's face: its vertices in order, and which tetrahedron has it.
struct PatchFace {
  std::array<std::int32_t, 3> vertices;
  std::int32_t tet;
  auto operator<=>(const PatchFace&) const = default;
};

std::vector<PatchFace> all_faces(std::span<const Tetrahedron> tetrahedra) {
  std::vector<PatchFace> faces;
  faces.reserve(4 * tetrahedra.size());
  for (std::size_t t = 0; t < tetrahedra.size(); ++t) {
    Tetrahedron sorted = tetrahedra[t];
    std::sort(sorted.begin(), sorted.end());
    for (std::size_t left_out = 0; left_out < 4; ++left_out) {
      PatchFace face{{}, static_cast<std::int32_t>(t)};
      std::size_t n = 0;
      for (std::size_t i = 0; i < 4; ++i) {
        if (i != left_out) {
          face.vertices[n++] = sorted[i];
        }
      }
      faces.push_back(face);
    }
  }
  std::sort(faces.begin(), faces.end());
  return faces;
}

Neighbours neighbours_of(std::span<const Tetrahedron> tetrahedra) {
  const std::vector<PatchFace> faces = all_faces(tetrahedra);
  Neighbours found(tetrahedra.size(), {-1, -1, -1, -1});
  const auto join = [&](std::int32_t a, std::int32_t b) {
    auto& list = found[static_cast<std::size_t>(a)];
    *std::find(list.begin(), list.end(), -1) = b;
  };
  for (std::size_t i = 1; i < faces.size(); ++i) {
    if (faces[i].vertices != faces[i - 1].vertices) {
      continue;
    }
    if (i > 1 && faces[i].vertices == faces[i - 2].vertices) {
      const auto& v = faces[i].vertices;
      throw InputError(
          fmt::format("tetrahedra: 3 share the face of vertices {}, {} and {}; at most 2 may", v[0],
                      v[1], v[2]));
    }
    join(faces[i].tet, faces[i - 1].tet);
    join(faces[i - 1].tet, faces[i].tet);
  }
  return found;
}

class PatchGrowth {
 public:
  PatchGrowth(std::span<const Tetrahedron> tetrahedra, std::span<const std::uint8_t> of)
      : tetrahedra_(tetrahedra),
        of_(of),
        neighbours_(neighbours_of(tetrahedra)),
        patch_of_(tetrahedra.size(), -1) {}

  std::vector<std::int32_t> grow() {
    std::int32_t patches = 0;
    for (std::size_t seed = 0; seed < tetrahedra_.size(); ++seed) {
      if (patch_of_[seed] < 0) {
        grow_from(static_cast<std::int32_t>(seed), patches++);
      }
    }
    return patch_of_;
  }

 private:
  bool alike(std::int32_t a, std::int32_t b) const {
    return material(of_, static_cast<std::size_t>(a)) == material(of_, static_cast<std::size_t>(b));
  }

  int known_corners(std::int32_t tet, const std::vector<std::int32_t>& vertices) const {
    const Tetrahedron& t = tetrahedra_[static_cast<std::size_t>(tet)];
    return static_cast<int>(std::count_if(t.begin(), t.end(), [&](std::int32_t v) {
      return std::find(vertices.begin(), vertices.end(), v) != vertices.end();
    }));
  }

  /// The free neighbour with most corners among the patch's vertices, or -1.
  std::int32_t best_neighbour(const std::vector<std::int32_t>& patch,
                              const std::vector<std::int32_t>& vertices) const {
    std::int32_t best = -1;
    int most = 0;
    for (const std::int32_t tet : patch) {
      for (const std::int32_t next : neighbours_[static_cast<std::size_t>(tet)]) {
        if (next < 0 || patch_of_[static_cast<std::size_t>(next)] >= 0 || !alike(tet, next)) {
          continue;
        }
        const int known = known_corners(next, vertices);
        if (known > most) {
          most = known;
          best = next;
        }
      }
    }
    return best;
  }

  void grow_from(std::int32_t seed, std::int32_t number) {
    std::vector<std::int32_t> patch;
    std::vector<std::int32_t> vertices;
    for (std::int32_t next = seed; next >= 0 && patch.size() < kGrown;
         next = best_neighbour(patch, vertices)) {
      patch.push_back(next);
      patch_of_[static_cast<std::size_t>(next)] = number;
      const Tetrahedron& t = tetrahedra_[static_cast<std::size_t>(next)];
      vertices.insert(vertices.end(), t.begin(), t.end());
    }
    if (patch.size() < kAlone) {
      join_neighbour(patch, number);
    }
  }

  void join_neighbour(const std::vector<std::int32_t>& patch, std::int32_t number) {
    for (const std::int32_t tet : patch) {
      for (const std::int32_t next : neighbours_[static_cast<std::size_t>(tet)]) {
        if (next < 0 || !alike(tet, next)) {
          continue;
        }
        const std::int32_t other = patch_of_[static_cast<std::size_t>(next)];
        if (other < 0 || other == number) {
          continue;
        }
        for (const std::int32_t t : patch) {
          patch_of_[static_cast<std::size_t>(t)] = other;
        }
        return;
      }
    }
  }

  std::span<const Tetrahedron> tetrahedra_;
  std::span<const std::uint8_t> of_;
  Neighbours neighbours_;
  std::vector<std::int32_t> patch_of_;
};

/// The same patches numbered from 0 by their first tetrahedra.
void renumber(std::vector<std::int32_t>& patch_of) {
  std::vector<std::int32_t> number(patch_of.size(), -1);
  std::int32_t patches = 0;
  for (std::int32_t& patch : patch_of) {
    std::int32_t& to = number[static_cast<std::size_t>(patch)];
    if (to < 0) {
      to = patches++;
    }
    patch = to;
  }
}

/// Sets tets and first_tet.
void group_tets(std::span<const std::int32_t> patch_of, PatchLayout& layout) {
  const std::int32_t patches = *std::max_element(patch_of.begin(), patch_of.end()) + 1;
  layout.first_tet.assign(static_cast<std::size_t>(patches) + 1, 0);
  for (const std::int32_t patch : patch_of) {
    ++layout.first_tet[static_cast<std::size_t>(patch) + 1];
  }
  std::partial_sum(layout.first_tet.begin(), layout.first_tet.end(), layout.first_tet.begin());
  layout.tets.resize(patch_of.size());
  std::vector<std::int32_t> at(layout.first_tet.begin(), layout.first_tet.end() - 1);
  for (std::size_t t = 0; t < patch_of.size(); ++t) {
    std::int32_t& place = at[static_cast<std::size_t>(patch_of[t])];
    layout.tets[static_cast<std::size_t>(place++)] = static_cast<std::int32_t>(t);
  }
}

}  // namespace

std::vector<std::int32_t> volume_patches(std::span<const Tetrahedron> tetrahedra,
                                         std::span<const std::uint8_t> material_of,
                                         VolumeForm form) {
  std::vector<std::int32_t> patch_of(tetrahedra.size());
  if (form == VolumeForm::kTetrahedra) {
    std::iota(patch_of.begin(), patch_of.end(), 0);
  } else if (all_are_cubes(tetrahedra, material_of)) {
    for (std::size_t i = 0; i < patch_of.size(); ++i) {
      patch_of[i] = static_cast<std::int32_t>(i / kCube);
    }
  } else {
    patch_of = PatchGrowth(tetrahedra, material_of).grow();
    renumber(patch_of);
  }
  return patch_of;
}

PatchLayout patch_layout(std::span<const Tetrahedron> tetrahedra,
                         std::span<const std::int32_t> patch_of) {
  PatchLayout layout;
  group_tets(patch_of, layout);
  layout.corners.resize(tetrahedra.size());
  layout.first_vertex.push_back(0);
  for (std::size_t p = 0; p + 1 < layout.first_tet.size(); ++p) {
    const auto first = static_cast<std::size_t>(layout.first_tet[p]);
    const auto end = static_cast<std::size_t>(layout.first_tet[p + 1]);
    std::vector<std::int32_t> vertices;
    for (std::size_t i = first; i < end; ++i) {
      const Tetrahedron& t = tetrahedra[static_cast<std::size_t>(layout.tets[i])];
      vertices.insert(vertices.end(), t.begin(), t.end());
    }
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    for (std::size_t i = first; i < end; ++i) {
      Tetrahedron t = tetrahedra[static_cast<std::size_t>(layout.tets[i])];
      std::sort(t.begin(), t.end());
      std::transform(t.begin(), t.end(), layout.corners[i].begin(), [&](std::int32_t v) {
        const auto found = std::lower_bound(vertices.begin(), vertices.end(), v);
        return static_cast<std::uint8_t>(found - vertices.begin());
      });
    }
    layout.vertices.insert(layout.vertices.end(), vertices.begin(), vertices.end());
    layout.first_vertex.push_back(static_cast<std::int32_t>(layout.vertices.size()));
  }
  return layout;
}

}  // namespace haptrial::deformable
