#include "core/geometry/volume/mesh_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/geometry/mesh/mesh_edges.h"
#include "core/geometry/mesh/mesh_size.h"

namespace haptrial::geometry {
namespace {

void check_triangles(const Mesh& mesh, MeshReport& report) {
  std::vector<bool> used(mesh.vertices.size(), false);
  std::vector<Triangle> sorted;
  sorted.reserve(mesh.triangles.size());
  for (Triangle triangle : mesh.triangles) {
    for (const std::int32_t corner : triangle) {
      used[corner] = true;
    }
    const double area = doubled_area(mesh, triangle);
    report.area += 0.5 * area;
    if (has_repeated_corner(triangle)) {
      ++report.repeated_corner_triangles;
      continue;
    }
    report.flat_triangles += area == 0.0;
    std::sort(triangle.begin(), triangle.end());
    sorted.push_back(triangle);
  }
  std::sort(sorted.begin(), sorted.end());
  for (std::size_t i = 1; i < sorted.size(); ++i) {
    report.duplicate_triangles += sorted[i] == sorted[i - 1];
  }
  report.unreferenced_vertices =
      static_cast<std::size_t>(std::count(used.begin(), used.end(), false));
}

std::uint32_t next_corner(Side side) { return side - side % 3 + (side + 1) % 3; }

/// The corners of triangles, united where triangles go around a vertex from edge to edge: each set
/// is a vertex as the surface sees it.
UnionFind fans(const Mesh& mesh, const EdgeTable& edges) {
  UnionFind corners(3 * mesh.triangles.size());
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const auto sides = edges.sides(e);
    for (std::size_t i = 1; i < sides.size(); ++i) {
      const bool same = start_of(mesh, sides[0]) == start_of(mesh, sides[i]);
      corners.unite(sides[0], same ? sides[i] : next_corner(sides[i]));
      corners.unite(next_corner(sides[0]), same ? next_corner(sides[i]) : sides[i]);
    }
  }
  return corners;
}

struct FanCount {
  std::size_t fans{0};
  std::size_t shared_vertices{0};  // with more than one fan
};

FanCount count_fans(const Mesh& mesh, UnionFind& corners) {
  FanCount count;
  std::vector<std::uint8_t> at(mesh.vertices.size(), 0);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::uint32_t c = 0; c < 3 && !has_repeated_corner(mesh.triangles[t]); ++c) {
      const auto corner = static_cast<std::uint32_t>(3 * t + c);
      if (corners.root(corner) == corner) {
        ++count.fans;
        std::uint8_t& here = at[mesh.triangles[t][c]];
        count.shared_vertices += here == 1;
        here = static_cast<std::uint8_t>(std::min(here + 1, 2));
      }
    }
  }
  return count;
}

std::size_t count_loops(const EdgeTable& edges, UnionFind& corners) {
  UnionFind along = corners;
  std::vector<std::uint32_t> starts;
  for (std::size_t e = 0; e < edges.size(); ++e) {
    if (edges.sides(e).size() == 1) {
      const Side side = edges.sides(e)[0];
      along.unite(side, next_corner(side));
      starts.push_back(side);
    }
  }
  for (std::uint32_t& start : starts) {
    start = along.root(start);
  }
  std::sort(starts.begin(), starts.end());
  return static_cast<std::size_t>(std::unique(starts.begin(), starts.end()) - starts.begin());
}

void check_edges(const Mesh& mesh, const EdgeTable& edges, MeshReport& report) {
  report.edges = edges.size();
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const auto sides = edges.sides(e);
    report.odd_edges += sides.size() % 2;
    report.boundary_edges += sides.size() == 1;
    report.nonmanifold_edges += sides.size() > 2;
    report.disagreeing_edges +=
        sides.size() == 2 && start_of(mesh, sides[0]) == start_of(mesh, sides[1]);
  }
  report.closed = edges.size() > 0 && report.odd_edges == 0;
}

/// Handles from the Euler characteristic V - E + F = 2 components - 2 genus - loops, with each fan
/// as a vertex of its own.
void check_topology(const Mesh& mesh, const EdgeTable& edges, MeshReport& report) {
  const Orientation turned = orientation(mesh, edges);
  std::vector<bool> counts(turned.components, false);  // has a triangle without repeated corners
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    counts[turned.component[t]] =
        counts[turned.component[t]] || !has_repeated_corner(mesh.triangles[t]);
  }
  report.components = static_cast<std::size_t>(std::count(counts.begin(), counts.end(), true));
  report.one_sided_components =
      static_cast<std::size_t>(std::count(turned.one_sided.begin(), turned.one_sided.end(), true));
  UnionFind corners = fans(mesh, edges);
  const FanCount count = count_fans(mesh, corners);
  report.nonmanifold_vertices = count.shared_vertices;
  report.boundary_loops = count_loops(edges, corners);
  if (report.nonmanifold_edges == 0 && report.one_sided_components == 0) {
    const std::size_t faces = report.triangles - report.repeated_corner_triangles;
    const std::size_t doubled =
        2 * report.components + report.edges - report.boundary_loops - count.fans - faces;
    report.genus = doubled / 2;
  }
}

}  // namespace

MeshReport check_mesh(const Mesh& mesh) {
  MeshReport report;
  report.vertices = mesh.vertices.size();
  report.triangles = mesh.triangles.size();
  report.box = bounds(mesh);
  report.volume = signed_volume(mesh);
  check_triangles(mesh, report);
  const EdgeTable edges(mesh);
  check_edges(mesh, edges, report);
  check_topology(mesh, edges, report);
  if (report.closed && report.oriented()) {
    report.facing = facing(mesh);
  }
  return report;
}

namespace {

std::string counted(std::size_t number, const char* one, const char* many) {
  return fmt::format("{} {}", number, number == 1 ? one : many);
}

const char* words_of(Facing facing) {
  switch (facing) {
    case Facing::kOutwards:
      return ", faces look outwards";
    case Facing::kInwards:
      return ", faces look inwards";
    case Facing::kNeither:
      return ", each face has one that looks the other way, so that nothing is inside";
    case Facing::kMixed:
      break;
  }
  return ", faces of some parts look inwards and of others outwards, so that the volume is a "
         "difference";
}

/// The side of an open surface that counts as its inside, where it is much like a closed one: of a
/// ball with a hole the volume is a tenth of area and diagonal, of a sheet it says nothing.
const char* open_words(const MeshReport& r) {
  constexpr double kLikeASheet = 0.06;
  if (!r.oriented() || std::abs(r.volume) <= kLikeASheet * r.area * r.box.diagonal().norm()) {
    return "";
  }
  return r.volume > 0.0 ? ", faces look outwards from its middle"
                        : ", faces look inwards to its middle";
}

std::string surface_sentence(const MeshReport& r) {
  if (r.edges == 0) {
    return "no surface: every triangle repeats a corner";
  }
  if (r.closed) {
    return fmt::format("closed{}{}", r.manifold() ? ", manifold" : "",
                       r.oriented() ? words_of(r.facing) : "");
  }
  if (r.boundary_edges == 0) {
    return fmt::format(
        "without a boundary, but not closed: {} of three triangles or another odd "
        "number, as where a face is there twice or a wall stands inside",
        counted(r.odd_edges, "edge", "edges"));
  }
  return fmt::format("open: {} in {}{}",
                     counted(r.boundary_edges, "boundary edge", "boundary edges"),
                     counted(r.boundary_loops, "loop", "loops"), open_words(r));
}

}  // namespace

std::vector<std::string> describe(const MeshReport& r) {
  std::vector<std::string> lines;
  lines.push_back(fmt::format("size        {}, {}, {}", counted(r.vertices, "vertex", "vertices"),
                              counted(r.triangles, "triangle", "triangles"),
                              counted(r.edges, "edge", "edges")));
  if (!r.box.isEmpty()) {
    const Eigen::Vector3d sides = r.box.sizes();
    lines.push_back(fmt::format(
        "box         {:.6g} x {:.6g} x {:.6g} m from ({:.6g}, {:.6g}, {:.6g})", sides.x(),
        sides.y(), sides.z(), r.box.min().x(), r.box.min().y(), r.box.min().z()));
  }
  lines.push_back("surface     " + surface_sentence(r));
  lines.push_back(fmt::format("pieces      {}{}", counted(r.components, "component", "components"),
                              r.genus ? fmt::format(", genus {}", *r.genus)
                                      : ", no genus: the surface is not an orientable manifold"));
  lines.push_back(
      r.closed && r.oriented()
          ? fmt::format("measures    area {:.6g} m2, volume {:.6g} m3", r.area, r.volume)
          : fmt::format("measures    area {:.6g} m2", r.area));
  const auto flaw = [&](std::size_t number, const char* one, const char* many) {
    if (number > 0) {
      lines.push_back("flaw        " + counted(number, one, many));
    }
  };
  flaw(r.unreferenced_vertices, "vertex that no triangle uses", "vertices that no triangle uses");
  flaw(r.repeated_corner_triangles, "triangle that repeats a corner",
       "triangles that repeat a corner");
  flaw(r.flat_triangles, "triangle without area", "triangles without area");
  flaw(r.duplicate_triangles, "triangle twice", "triangles twice");
  flaw(r.nonmanifold_edges, "edge of three or more triangles", "edges of three or more triangles");
  flaw(r.nonmanifold_vertices, "vertex where several fans touch",
       "vertices where several fans touch");
  flaw(r.disagreeing_edges, "edge whose triangles face opposite ways",
       "edges whose triangles face opposite ways");
  flaw(r.one_sided_components, "component that has only one side",
       "components that have only one side");
  return lines;
}

}  // namespace haptrial::geometry
