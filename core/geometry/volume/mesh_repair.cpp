#include "core/geometry/volume/mesh_repair.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <unordered_map>

#include "core/base/error.h"
#include "core/geometry/bvh/bvh.h"
#include "core/geometry/mesh/mesh_edges.h"
#include "core/geometry/mesh/point_index.h"

namespace haptrial::geometry {
namespace {

/// Points that were kept, in cells as wide as the tolerance. Cells are doubles: if a coordinate is
/// so large that its cells are wider than one, points within the tolerance of each other are equal.
class NearbyPoints {
 public:
  explicit NearbyPoints(double tolerance) : tolerance_(tolerance) {}

  /// The first kept point within the tolerance; `mine`, now kept, where there is none.
  std::int32_t first_near(const Eigen::Vector3d& point, std::int32_t mine,
                          const std::vector<Eigen::Vector3d>& points) {
    std::int32_t found = std::numeric_limits<std::int32_t>::max();
    const Eigen::Array3d cell = (point / tolerance_).array().floor();
    for (int n = 0; n < 27; ++n) {
      const auto at = heads_.find(cell + Eigen::Array3d(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1));
      for (std::int32_t i = at == heads_.end() ? -1 : at->second; i >= 0; i = next_[i]) {
        if (kept_[i] < found && (points[kept_[i]] - point).norm() <= tolerance_) {
          found = kept_[i];
        }
      }
    }
    if (found != std::numeric_limits<std::int32_t>::max()) {
      return found;
    }
    const auto [head, is_new] = heads_.try_emplace(cell, -1);
    next_.push_back(head->second);
    head->second = static_cast<std::int32_t>(kept_.size());
    kept_.push_back(mine);
    return mine;
  }

 private:
  struct Hash {
    std::size_t operator()(const Eigen::Array3d& cell) const {
      std::uint64_t mixed = 0;
      for (const double value : cell) {
        mixed = (mixed ^ std::bit_cast<std::uint64_t>(value + 0.0)) * 0x9E3779B97F4A7C15u;
        mixed ^= mixed >> 29;
      }
      return mixed;
    }
  };
  struct Equal {
    bool operator()(const Eigen::Array3d& a, const Eigen::Array3d& b) const {
      return (a == b).all();
    }
  };

  double tolerance_;
  std::unordered_map<Eigen::Array3d, std::int32_t, Hash, Equal> heads_;  // by cell, into kept_
  std::vector<std::int32_t> kept_;
  std::vector<std::int32_t> next_;  // in the same cell
};

/// The triangles for which `keep` holds. @returns how many went.
template <class Keep>
std::size_t keep_triangles(Mesh& mesh, Keep keep) {
  std::size_t kept = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (keep(t)) {
      mesh.triangles[kept++] = mesh.triangles[t];
    }
  }
  const std::size_t gone = mesh.triangles.size() - kept;
  mesh.triangles.resize(kept);
  return gone;
}

Triangle sorted(Triangle triangle) {
  std::sort(triangle.begin(), triangle.end());
  return triangle;
}

/// The corner of a flat triangle at which its longest side begins.
std::uint32_t longest_side(const Mesh& mesh, const Triangle& t) {
  std::uint32_t longest = 0;
  double length = -1.0;
  for (std::uint32_t c = 0; c < 3; ++c) {
    const double here = (mesh.vertices[t[(c + 1) % 3]] - mesh.vertices[t[c]]).norm();
    if (here > length) {
      length = here;
      longest = c;
    }
  }
  return longest;
}

/// Turns the longest sides of flat triangles where that helps. @returns how many turned.
std::size_t turn_flat(Mesh& mesh) {
  std::vector<std::uint32_t> flat;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (doubled_area(mesh, mesh.triangles[t]) == 0.0) {
      flat.push_back(static_cast<std::uint32_t>(t));
    }
  }
  if (flat.empty()) {
    return 0;
  }
  const EdgeTable edges(mesh);
  std::vector<Side> across(3 * mesh.triangles.size(), std::numeric_limits<Side>::max());
  std::vector<std::pair<std::int32_t, std::int32_t>> ends;
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const auto sides = edges.sides(e);
    if (sides.size() == 2 && start_of(mesh, sides[0]) == end_of(mesh, sides[1])) {
      across[sides[0]] = sides[1];
      across[sides[1]] = sides[0];
    }
    ends.emplace_back(std::minmax(start_of(mesh, sides[0]), end_of(mesh, sides[0])));
  }
  std::vector<bool> busy(mesh.triangles.size(), false);
  std::size_t turned = 0;
  for (const std::uint32_t t : flat) {
    const Triangle flat_one = mesh.triangles[t];
    const std::uint32_t c = longest_side(mesh, flat_one);
    const Side other = across[3 * t + c];
    if (busy[t] || other == std::numeric_limits<Side>::max() || busy[other / 3] ||
        doubled_area(mesh, mesh.triangles[other / 3]) == 0.0) {
      continue;
    }
    const std::int32_t a = flat_one[c];
    const std::int32_t b = flat_one[(c + 1) % 3];
    const std::int32_t tip = flat_one[(c + 2) % 3];
    const std::int32_t far = mesh.triangles[other / 3][(other % 3 + 2) % 3];
    const std::pair<std::int32_t, std::int32_t> diagonal(std::min(tip, far), std::max(tip, far));
    if (tip == far || std::binary_search(ends.begin(), ends.end(), diagonal)) {
      continue;
    }
    mesh.triangles[t] = {a, far, tip};
    mesh.triangles[other / 3] = {far, b, tip};
    busy[t] = busy[other / 3] = true;
    ++turned;
  }
  return turned;
}

/// The part of a mesh that one component is.
struct Component {
  std::vector<std::uint32_t> triangles;
  bool closed{true};
  bool one_sided{false};
  Eigen::AlignedBox3d box;
};

/// Six times the volume; 0 where its parts cancel but for rounding.
double volume_of(const Mesh& mesh, const Component& part) {
  constexpr double kRounding = 1e-12;  // of the parts in sum
  const Eigen::Vector3d middle = part.box.center();
  double sixfold = 0.0;
  double sizes = 0.0;
  for (const std::uint32_t t : part.triangles) {
    const Triangle& corners = mesh.triangles[t];
    const Eigen::Vector3d a = mesh.vertices[corners[0]] - middle;
    const Eigen::Vector3d b = mesh.vertices[corners[1]] - middle;
    const double part_of_it = a.dot(b.cross(mesh.vertices[corners[2]] - middle));
    sixfold += part_of_it;
    sizes += std::abs(part_of_it);
  }
  return std::abs(sixfold) > kRounding * sizes ? sixfold : 0.0;
}

std::vector<Component> components_of(const Mesh& mesh, const EdgeTable& edges,
                                     const Orientation& turned) {
  std::vector<Component> parts(turned.components);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    Component& part = parts[turned.component[t]];
    part.triangles.push_back(static_cast<std::uint32_t>(t));
    for (const std::int32_t corner : mesh.triangles[t]) {
      part.box.extend(mesh.vertices[corner]);
    }
    part.closed = part.closed && !has_repeated_corner(mesh.triangles[t]);
  }
  for (std::size_t e = 0; e < edges.size(); ++e) {
    if (edges.sides(e).size() % 2 != 0) {
      parts[turned.component[edges.sides(e)[0] / 3]].closed = false;
    }
  }
  for (std::size_t p = 0; p < parts.size(); ++p) {
    parts[p].one_sided = turned.one_sided[p];
  }
  return parts;
}

/// Whether a component lies in an odd number of other closed ones: a ray from it leaves them. One
/// that only reaches into another is no cavity; it sticks out of the other's box.
bool is_cavity(const Mesh& mesh, const Bvh& hierarchy, const Orientation& turned,
               const std::vector<Component>& parts, std::size_t which) {
  const std::int32_t start = mesh.triangles[parts[which].triangles[0]][0];
  std::vector<RayHit> hits;
  hierarchy.all_hits({mesh.vertices[start], Eigen::Vector3d::UnitX()}, hits);
  const auto leaves_another = [&](const RayHit& hit) {
    const std::uint32_t component = turned.component[hit.triangle];
    return component != which && parts[component].closed &&
           parts[component].box.contains(parts[which].box);
  };
  return std::count_if(hits.begin(), hits.end(), leaves_another) % 2 == 1;
}

}  // namespace

std::size_t weld(Mesh& mesh, double tolerance) {
  std::vector<std::int32_t> target(mesh.vertices.size());
  std::size_t welded = 0;
  if (tolerance > 0.0) {
    NearbyPoints near(tolerance);
    for (std::size_t v = 0; v < target.size(); ++v) {
      target[v] = near.first_near(mesh.vertices[v], static_cast<std::int32_t>(v), mesh.vertices);
    }
  } else {
    PointIndex points(mesh.vertices.size());
    std::vector<std::int32_t> first;
    for (std::size_t v = 0; v < target.size(); ++v) {
      const std::int32_t number = points.number(mesh.vertices[v]);
      if (static_cast<std::size_t>(number) == first.size()) {
        first.push_back(static_cast<std::int32_t>(v));
      }
      target[v] = first[number];
    }
  }
  // Welded vertices go; those that no triangle used before stay, for remove_unreferenced to count.
  std::vector<std::int32_t> now(target.size());
  std::vector<Eigen::Vector3d> kept;
  for (std::size_t v = 0; v < target.size(); ++v) {
    if (static_cast<std::size_t>(target[v]) == v) {
      now[v] = static_cast<std::int32_t>(kept.size());
      kept.push_back(mesh.vertices[v]);
    } else {
      now[v] = now[target[v]];
      ++welded;
    }
  }
  for (Triangle& triangle : mesh.triangles) {
    for (std::int32_t& corner : triangle) {
      corner = now[corner];
    }
  }
  mesh.vertices = std::move(kept);
  return welded;
}

std::size_t remove_degenerate(Mesh& mesh) {
  std::size_t changed =
      keep_triangles(mesh, [&](std::size_t t) { return !has_repeated_corner(mesh.triangles[t]); });
  // Turning may leave another flat triangle where several lie in one line: a few rounds settle it.
  constexpr int kRounds = 16;
  for (int round = 0; round < kRounds; ++round) {
    const std::size_t turned = turn_flat(mesh);
    changed += turned;
    if (turned == 0) {
      break;
    }
  }
  return changed;
}

std::size_t remove_duplicates(Mesh& mesh) {
  std::vector<std::uint32_t> order(mesh.triangles.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    const Triangle left = sorted(mesh.triangles[a]);
    const Triangle right = sorted(mesh.triangles[b]);
    return left != right ? left < right : a < b;
  });
  std::vector<bool> again(mesh.triangles.size(), false);
  for (std::size_t i = 1; i < order.size(); ++i) {
    again[order[i]] = sorted(mesh.triangles[order[i]]) == sorted(mesh.triangles[order[i - 1]]);
  }
  return keep_triangles(mesh, [&](std::size_t t) { return !again[t]; });
}

std::size_t remove_unreferenced(Mesh& mesh) {
  std::vector<std::int32_t> now(mesh.vertices.size(), -1);
  for (const Triangle& triangle : mesh.triangles) {
    for (const std::int32_t corner : triangle) {
      now[corner] = 0;
    }
  }
  std::int32_t kept = 0;
  for (std::size_t v = 0; v < now.size(); ++v) {
    if (now[v] == 0) {
      mesh.vertices[kept] = mesh.vertices[v];
      now[v] = kept++;
    }
  }
  const std::size_t gone = mesh.vertices.size() - static_cast<std::size_t>(kept);
  mesh.vertices.resize(static_cast<std::size_t>(kept));
  for (Triangle& triangle : mesh.triangles) {
    for (std::int32_t& corner : triangle) {
      corner = now[corner];
    }
  }
  return gone;
}

std::size_t orient(Mesh& mesh) {
  const EdgeTable edges(mesh);
  const Orientation turned = orientation(mesh, edges);
  const std::vector<Component> parts = components_of(mesh, edges, turned);
  const std::vector<Triangle> before = mesh.triangles;
  for (const Component& part : parts) {
    for (const std::uint32_t t : part.triangles) {
      if (turned.turn[t] && !part.one_sided) {
        std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
      }
    }
  }
  std::optional<Bvh> hierarchy;
  if (parts.size() > 1) {
    hierarchy.emplace(mesh);
  }
  for (std::size_t p = 0; p < parts.size(); ++p) {
    const bool inwards =
        hierarchy && parts[p].closed && is_cavity(mesh, *hierarchy, turned, parts, p);
    if (!parts[p].one_sided && (volume_of(mesh, parts[p]) < 0.0) != inwards) {
      for (const std::uint32_t t : parts[p].triangles) {
        std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
      }
    }
  }
  std::size_t changed = 0;
  for (std::size_t t = 0; t < before.size(); ++t) {
    changed += before[t] != mesh.triangles[t];
  }
  return changed;
}

Facing facing(const Mesh& mesh) {
  const EdgeTable edges(mesh);
  const Orientation turned = orientation(mesh, edges);
  const std::vector<Component> parts = components_of(mesh, edges, turned);
  std::optional<Bvh> hierarchy;
  if (parts.size() > 1) {
    hierarchy.emplace(mesh);
  }
  bool outwards = false;
  bool inwards = false;
  bool neither = false;
  for (std::size_t p = 0; p < parts.size(); ++p) {
    if (parts[p].closed && !(hierarchy && is_cavity(mesh, *hierarchy, turned, parts, p))) {
      const double volume = volume_of(mesh, parts[p]);
      outwards = outwards || volume > 0.0;
      inwards = inwards || volume < 0.0;
      neither = neither || volume == 0.0;
    }
  }
  if (inwards) {
    return outwards ? Facing::kMixed : Facing::kInwards;
  }
  return neither && !outwards ? Facing::kNeither : Facing::kOutwards;
}

RepairReport repair(Mesh& mesh, const RepairOptions& options) {
  if (!(options.weld_tolerance >= 0.0) || !std::isfinite(options.weld_tolerance)) {
    throw std::invalid_argument("repair: the weld tolerance must be 0 or more");
  }
  RepairReport report;
  report.welded_vertices = weld(mesh, options.weld_tolerance);
  report.degenerate_triangles = remove_degenerate(mesh);
  report.duplicate_triangles = remove_duplicates(mesh);
  report.unreferenced_vertices = remove_unreferenced(mesh);
  if (mesh.triangles.empty()) {
    throw InputError("every triangle repeats a corner, so nothing is left of the mesh");
  }
  report.turned_triangles = orient(mesh);
  return report;
}

}  // namespace haptrial::geometry
