#include "core/deformable/body/load_case.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>

#include "core/base/error.h"
#include "core/deformable/body/mesh_parts.h"

namespace haptrial::deformable {
namespace {

using Eigen::Vector3d;
using geometry::TetMesh;
using geometry::Tetrahedron;

constexpr double kFlat = 1e-6;  // of the longest edge's cube

const Vector3d& corner(const TetMesh& body, const Tetrahedron& t, std::size_t i) {
  return body.vertices[static_cast<std::size_t>(t[i])];
}

double longest_edge(const TetMesh& body, const Tetrahedron& t) {
  double longest = 0;
  for (std::size_t i = 0; i < t.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      longest = std::max(longest, (corner(body, t, i) - corner(body, t, j)).norm());
    }
  }
  return longest;
}

void check_corners(const TetMesh& body, const std::string& name) {
  std::vector<bool> used(body.vertices.size(), false);
  for (std::size_t i = 0; i < body.tetrahedra.size(); ++i) {
    for (const std::int32_t vertex : body.tetrahedra[i]) {
      if (vertex < 0 || static_cast<std::size_t>(vertex) >= body.vertices.size()) {
        throw InputError(fmt::format("{}: tetrahedron {} has the vertex {}; there are 0 to {}",
                                     name, i, vertex, body.vertices.size() - 1));
      }
      used[static_cast<std::size_t>(vertex)] = true;
    }
  }
  for (std::size_t v = 0; v < used.size(); ++v) {
    if (!used[v]) {
      throw InputError(fmt::format("{}: no tetrahedron has the vertex {}; remove it", name, v));
    }
    if (!body.vertices[v].allFinite()) {
      throw InputError(fmt::format("{}: vertex {} is not finite", name, v));
    }
  }
}

/// Whether three of the points span a plane: some point lies off the line through the two that are
/// far apart.
bool span_a_plane(const std::vector<Vector3d>& points) {
  constexpr double kOff = 1e-9;  // of the line's length
  if (points.size() < 3) {
    return false;
  }
  const Vector3d& a = points.front();
  const Vector3d b = *std::max_element(
      points.begin(), points.end(),
      [&](const Vector3d& p, const Vector3d& q) { return (p - a).norm() < (q - a).norm(); });
  const double length = (b - a).norm();
  return std::any_of(points.begin(), points.end(), [&](const Vector3d& p) {
    return (b - a).cross(Vector3d(p - a)).norm() > kOff * length * length;
  });
}

void check_vertex(const TetMesh& body, const LoadCase& load, std::int32_t vertex) {
  if (vertex < 0 || static_cast<std::size_t>(vertex) >= body.vertices.size()) {
    throw InputError(fmt::format("load '{}': there is no vertex {}; the body has 0 to {}",
                                 load.name, vertex, body.vertices.size() - 1));
  }
}

void check_finite(const LoadCase& load, const char* what, std::int32_t vertex, const Vector3d& v) {
  if (v.allFinite()) {
    return;
  }
  throw InputError(
      fmt::format("load '{}': the {} of vertex {} is not finite", load.name, what, vertex));
}

void check_values(const TetMesh& body, const LoadCase& load) {
  std::vector<bool> held(body.vertices.size(), false);
  bool acts = false;
  for (const Hold& hold : load.holds) {
    check_vertex(body, load, hold.vertex);
    check_finite(load, "displacement", hold.vertex, hold.displacement);
    if (held[static_cast<std::size_t>(hold.vertex)]) {
      throw InputError(fmt::format("load '{}': vertex {} is held twice", load.name, hold.vertex));
    }
    held[static_cast<std::size_t>(hold.vertex)] = true;
    acts = acts || !hold.displacement.isZero(0);
  }
  for (const NodalForce& nodal : load.forces) {
    check_vertex(body, load, nodal.vertex);
    check_finite(load, "force", nodal.vertex, nodal.force);
    acts = acts || !nodal.force.isZero(0);
  }
  if (!acts) {
    throw InputError(fmt::format("load '{}' has no force and moves no vertex", load.name));
  }
}

}  // namespace

std::vector<std::uint8_t> held_flags(std::size_t vertices, std::span<const Hold> holds) {
  std::vector<std::uint8_t> held(vertices, 0);
  for (const Hold& hold : holds) {
    held[static_cast<std::size_t>(hold.vertex)] = 1;
  }
  return held;
}

void check_body(const TetMesh& body, const std::string& name) {
  if (body.tetrahedra.empty()) {
    throw InputError(fmt::format("{}: there is no tetrahedron", name));
  }
  check_corners(body, name);
  for (std::size_t i = 0; i < body.tetrahedra.size(); ++i) {
    const Tetrahedron& t = body.tetrahedra[i];
    const double volume = six_volumes(body.vertices, t);
    const double longest = longest_edge(body, t);
    if (volume > kFlat * longest * longest * longest) {
      continue;
    }
    const bool inverted = volume < -kFlat * longest * longest * longest;
    throw InputError(fmt::format("{}: tetrahedron {} (vertices {}, {}, {}, {}) is {}", name, i,
                                 t[0], t[1], t[2], t[3], inverted ? "inverted" : "flat"));
  }
}

void check_load(const TetMesh& body, const LoadCase& load) {
  check_values(body, load);
  const std::vector<std::int32_t> part = connected_parts(body.tetrahedra, body.vertices.size());
  const std::int32_t parts = *std::max_element(part.begin(), part.end()) + 1;
  std::vector<std::vector<Vector3d>> held(static_cast<std::size_t>(parts));
  for (const Hold& hold : load.holds) {
    const auto vertex = static_cast<std::size_t>(hold.vertex);
    held[static_cast<std::size_t>(part[vertex])].push_back(body.vertices[vertex]);
  }
  for (std::size_t i = 0; i < held.size(); ++i) {
    if (span_a_plane(held[i])) {
      continue;
    }
    const auto first = std::find(part.begin(), part.end(), static_cast<std::int32_t>(i));
    throw InputError(fmt::format(
        "load '{}': nothing holds the part of the body with vertex {}: {} of its vertices are held "
        "and 3 that are not on a line are needed",
        load.name, first - part.begin(), held[i].size()));
  }
}

}  // namespace haptrial::deformable
