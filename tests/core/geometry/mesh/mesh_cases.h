#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "core/base/random.h"
#include "core/geometry/mesh/mesh.h"
#include "core/geometry/mesh/procedural.h"

namespace haptrial::geometry {

/// Meshes that are hard on a search, each with a name for messages.
struct MeshCase {
  std::string name;
  Mesh mesh;
};

inline Eigen::Vector3d random_point(RandomStream& random, double reach) {
  const double x = random.uniform(-reach, reach), y = random.uniform(-reach, reach);
  return {x, y, random.uniform(-reach, reach)};
}

/// Triangles apart from each other, of sizes up to `size`, in a cube of half side `reach`.
inline Mesh random_triangles(int count, double reach, double size, std::uint64_t seed) {
  RandomStream random(seed, "triangles");
  Mesh mesh;
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector3d middle = random_point(random, reach);
    for (int k = 0; k < 3; ++k) {
      mesh.vertices.push_back(middle + random_point(random, size));
    }
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  return mesh;
}

inline Mesh moved(Mesh mesh, double scale, const Eigen::Vector3d& by) {
  for (Eigen::Vector3d& vertex : mesh.vertices) {
    vertex = scale * vertex + by;
  }
  return mesh;
}

/// Needles: the third corner lies beside the edge of the first two, from not at all to a thousandth
/// of its length.
inline Mesh slivers(int count, std::uint64_t seed) {
  RandomStream random(seed, "slivers");
  Mesh mesh;
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector3d a = random_point(random, 1.0), b = random_point(random, 1.0);
    const double thin = i % 5 == 0 ? 0.0 : std::pow(10.0, random.uniform(-18.0, -3.0));
    const double along = random.uniform(-0.2, 1.2);
    const Eigen::Vector3d c = a + along * (b - a) + thin * random_point(random, 1.0);
    mesh.vertices.insert(mesh.vertices.end(), {a, b, c});
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  return mesh;
}

/// Triangles that are points, edges doubled back, and copies of each other.
inline Mesh degenerate(std::uint64_t seed) {
  Mesh mesh = random_triangles(60, 1.0, 0.3, seed);
  const auto count = static_cast<std::int32_t>(mesh.triangles.size());
  for (std::int32_t i = 0; i < count; ++i) {
    const Triangle t = mesh.triangles[i];
    mesh.triangles.push_back({t[0], t[0], t[0]});
    mesh.triangles.push_back({t[0], t[1], t[0]});
    mesh.triangles.push_back({t[1], t[2], t[0]});
    mesh.triangles.push_back({t[0], t[2], t[1]});
  }
  return mesh;
}

/// One triangle again and again.
inline Mesh copies(int count) {
  Mesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {}};
  mesh.triangles.assign(count, {0, 1, 2});
  return mesh;
}

/// Sizes over many orders of magnitude, towards one corner.
inline Mesh shrinking(int count) {
  Mesh mesh;
  for (int i = 0; i < count; ++i) {
    const double s = std::pow(0.9, i);
    mesh.vertices.insert(mesh.vertices.end(), {Eigen::Vector3d(s, 0, 0), Eigen::Vector3d(s, s, 0),
                                               Eigen::Vector3d(s, 0, s)});
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  return mesh;
}

inline std::vector<MeshCase> mesh_cases() {
  std::vector<MeshCase> cases;
  cases.push_back({"one triangle", copies(1)});
  cases.push_back({"200 copies of one triangle", copies(200)});
  cases.push_back({"small random triangles", random_triangles(1500, 1.0, 0.05, 1)});
  cases.push_back({"large random triangles", random_triangles(300, 1.0, 1.0, 2)});
  cases.push_back({"slivers", slivers(600, 3)});
  cases.push_back({"degenerate", degenerate(4)});
  cases.push_back({"shrinking", shrinking(400)});
  cases.push_back({"a sphere", make_sphere(1.0, 8)});
  cases.push_back({"a gear", make_gear()});
  cases.push_back({"a sphere 1e6 away", moved(make_sphere(1.0, 6), 1.0, {1e6, -1e6, 1e6})});
  cases.push_back({"a gear of 1e6", moved(make_gear(), 2e7, {0, 0, 0})});
  cases.push_back({"a gear of 1e-6", moved(make_gear(), 2e-5, {1e-6, 0, 0})});
  cases.push_back({"slivers of 1e-6 beside 1e6", moved(slivers(200, 5), 1e-6, {1e6, 0, 0})});
  Mesh wide = random_triangles(300, 1e6, 10.0, 6);
  const Mesh dense = random_triangles(300, 1e-3, 1e-4, 7);
  for (const Triangle& t : dense.triangles) {
    const auto first = static_cast<std::int32_t>(wide.vertices.size());
    for (const std::int32_t corner : t) {
      wide.vertices.push_back(dense.vertices[corner]);
    }
    wide.triangles.push_back({first, first + 1, first + 2});
  }
  cases.push_back({"a dense heap in a wide one", std::move(wide)});
  return cases;
}

/// Points around a mesh: near, far, on its corners and edges, in its faces, and midway.
inline std::vector<Eigen::Vector3d> hard_points(const Mesh& mesh, int count, std::uint64_t seed) {
  RandomStream random(seed, "points");
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& vertex : mesh.vertices) {
    box.extend(vertex);
  }
  const double size = std::max(box.sizes().maxCoeff(), 1e-300);
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < count; ++i) {
    const Triangle& t = mesh.triangles[random.below(mesh.triangles.size())];
    const Eigen::Vector3d &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]],
                          &c = mesh.vertices[t[2]];
    const double u = random.uniform(), v = random.uniform();
    switch (i % 8) {
      case 0:
        points.push_back(a);
        break;
      case 1:
        points.push_back(a + u * (b - a));
        break;
      case 2:
        points.push_back(a + 0.5 * u * (b - a) + 0.5 * v * (c - a));
        break;
      case 3:
        points.push_back(a + random_point(random, 1e-3 * size));
        break;
      case 4:
        points.push_back(box.center() + random_point(random, 1e4 * size));
        break;
      case 5:
        points.push_back(box.center() + random_point(random, 10 * size));
        break;
      default:
        points.push_back(box.center() + random_point(random, 0.6 * size));
    }
  }
  return points;
}

}  // namespace haptrial::geometry
