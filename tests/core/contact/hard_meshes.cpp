#include "tests/core/contact/hard_meshes.h"

#include <cmath>
#include <map>
#include <utility>

#include "core/base/random.h"
#include "core/geometry/files/mesh_io.h"
#include "core/geometry/mesh/procedural.h"
#include "tests/support/shared_data.h"

namespace haptrial::contact {
namespace {

using Eigen::Vector3d;
using geometry::Mesh;

/// A cone with `sides` sides: a needle where it is long.
Mesh make_cone(double radius, double length, int sides) {
  Mesh mesh{{{0, 0, 0}, {0, 0, length}}, {}};
  for (int i = 0; i < sides; ++i) {
    const double a = 2.0 * M_PI * i / sides;
    mesh.vertices.push_back({radius * std::cos(a), radius * std::sin(a), 0.0});
    const int here = 2 + i, next = 2 + (i + 1) % sides;
    mesh.triangles.push_back({1, here, next});
    mesh.triangles.push_back({0, next, here});
  }
  return mesh;
}

/// A solid with a V-shaped slot of half the angle `half_angle` [rad], 0.5 deep, open to +z.
Mesh make_slot(double half_angle) {
  const double w = 0.5 * std::tan(half_angle);
  const std::vector<Eigen::Vector2d> outline{{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {w, 0.5},
                                             {0.0, 0.0},   {-w, 0.5},   {-0.5, 0.5}};
  const auto count = static_cast<std::int32_t>(outline.size());
  Mesh mesh;
  for (const double y : {-0.5, 0.5}) {
    for (const Eigen::Vector2d& p : outline) {
      mesh.vertices.push_back({p.x(), y, p.y()});
    }
  }
  for (std::int32_t i = 0; i < count; ++i) {
    const std::int32_t next = (i + 1) % count;
    mesh.triangles.push_back({i, next, next + count});
    mesh.triangles.push_back({i, next + count, i + count});
  }
  const std::int32_t fans[5][3] = {{4, 5, 6}, {4, 6, 0}, {4, 0, 1}, {4, 1, 2}, {4, 2, 3}};
  for (const auto& t : fans) {
    mesh.triangles.push_back({t[0], t[2], t[1]});
    mesh.triangles.push_back({t[0] + count, t[1] + count, t[2] + count});
  }
  return mesh;
}

Mesh moved(Mesh mesh, const Vector3d& by) {
  for (Vector3d& v : mesh.vertices) {
    v += by;
  }
  return mesh;
}

/// Triangles without area on the edges of others, and others three times.
Mesh with_degenerate(Mesh mesh) {
  const std::size_t count = mesh.triangles.size();
  for (std::size_t i = 0; i < count; i += 3) {
    const geometry::Triangle t = mesh.triangles[i];
    mesh.triangles.push_back({t[0], t[1], t[0]});
    mesh.triangles.push_back({t[1], t[1], t[1]});
    mesh.triangles.insert(mesh.triangles.end(), 2, t);
  }
  return mesh;
}

}  // namespace

Mesh make_box(const Vector3d& low, const Vector3d& high) {
  Mesh mesh;
  for (int i = 0; i < 8; ++i) {
    mesh.vertices.push_back(
        {i & 1 ? high.x() : low.x(), i & 2 ? high.y() : low.y(), i & 4 ? high.z() : low.z()});
  }
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

Mesh joined(const Mesh& a, const Mesh& b) {
  Mesh mesh = a;
  const auto first = static_cast<std::int32_t>(a.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), b.vertices.begin(), b.vertices.end());
  for (const geometry::Triangle& t : b.triangles) {
    mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  }
  return mesh;
}

Mesh with_slivers(Mesh mesh, int count, std::uint64_t seed) {
  RandomStream random(seed, "slivers");
  for (int i = 0; i < count; ++i) {
    const geometry::Triangle chosen = mesh.triangles[random.below(mesh.triangles.size())];
    const auto k = static_cast<int>(random.below(3));
    const std::int32_t a = chosen[k], b = chosen[(k + 1) % 3];
    const double part = std::pow(10.0, random.uniform(-16.0, -3.0));
    const auto middle = static_cast<std::int32_t>(mesh.vertices.size());
    mesh.vertices.push_back(mesh.vertices[a] + part * (mesh.vertices[b] - mesh.vertices[a]));
    const std::size_t triangles = mesh.triangles.size();
    for (std::size_t t = 0; t < triangles; ++t) {
      for (int e = 0; e < 3; ++e) {
        const geometry::Triangle old = mesh.triangles[t];
        const std::int32_t from = old[e], to = old[(e + 1) % 3], third = old[(e + 2) % 3];
        if ((from == a && to == b) || (from == b && to == a)) {
          mesh.triangles[t] = {from, middle, third};
          mesh.triangles.push_back({middle, to, third});
          break;
        }
      }
    }
  }
  return mesh;
}

Mesh with_inverted_faces(Mesh mesh, std::uint64_t seed) {
  RandomStream random(seed, "inverted");
  for (geometry::Triangle& t : mesh.triangles) {
    if (random.below(2) == 0) {
      std::swap(t[1], t[2]);
    }
  }
  return mesh;
}

Mesh with_crack(Mesh mesh, double gap) {
  const std::int32_t old = mesh.triangles[0][0];
  mesh.triangles[0][0] = static_cast<std::int32_t>(mesh.vertices.size());
  const Vector3d middle =
      (mesh.vertices[mesh.triangles[0][1]] + mesh.vertices[mesh.triangles[0][2]]) / 2.0;
  mesh.vertices.push_back(mesh.vertices[old] + gap * (middle - mesh.vertices[old]).normalized());
  return mesh;
}

std::vector<HardMesh> hard_meshes() {
  const Mesh cube = make_box(Vector3d::Constant(-0.5), Vector3d::Constant(0.5));
  std::vector<HardMesh> meshes;
  meshes.push_back({"a cube", cube});
  meshes.push_back({"a sphere", geometry::make_sphere(0.5, 12)});
  meshes.push_back({"a torus", geometry::make_torus(0.4, 0.1, 60, 24)});
  geometry::GearShape gear;
  gear.tip_radius = 0.5;
  gear.root_radius = 0.4;
  gear.bore_radius = 0.2;
  gear.thickness = 0.2;
  meshes.push_back({"a gear", geometry::make_gear(gear)});
  meshes.push_back({"a rough solid", geometry::make_rough_solid(1.0, 16, 5)});
  meshes.push_back({"slivers on a sphere", with_slivers(geometry::make_sphere(0.5, 3), 250, 1)});
  meshes.push_back({"slivers on a cube", with_slivers(cube, 60, 2)});
  meshes.push_back({"a thin plate", make_box({-0.5, -0.5, -0.5e-3}, Vector3d(0.5, 0.5, 0.5e-3))});
  meshes.push_back(
      {"a plate of 1e-9", make_box({-0.5, -0.5, -0.5e-9}, Vector3d(0.5, 0.5, 0.5e-9))});
  meshes.push_back({"a plate of 1e-15, slivers on it",
                    with_slivers(make_box({-0.5, -0.5, 0}, Vector3d(0.5, 0.5, 1e-15)), 40, 3)});
  meshes.push_back({"inverted faces", with_inverted_faces(geometry::make_sphere(0.5, 8), 4)});
  meshes.push_back({"a crack of one vertex, 1e-6", with_crack(cube, 1e-6), false});
  meshes.push_back({"a crack of one vertex, 1e-13", with_crack(cube, 1e-13), false});
  meshes.push_back({"a needle", make_cone(1e-4, 1.0, 7)});
  meshes.push_back({"a blunt cone of 90 sides", make_cone(0.5, 1e-4, 90)});
  meshes.push_back({"a slot of 0.1 rad", make_slot(0.05)});
  meshes.push_back({"a slot of 1e-4 rad", make_slot(0.5e-4)});
  meshes.push_back({"two cubes that share an edge", joined(cube, moved(cube, {1.0, 1.0, 0.0}))});
  meshes.push_back({"cubes one in another's side", joined(cube, moved(cube, {0.7, 0.3, 0.2}))});
  meshes.push_back({"degenerate triangles", with_degenerate(geometry::make_sphere(0.5, 4))});
  Mesh sheet = geometry::make_sphere(0.5, 6);
  sheet.triangles.resize(sheet.triangles.size() / 2);
  meshes.push_back({"half a sphere, open", sheet, false});
  return meshes;
}

std::vector<HardMesh> scanned_meshes() {
  std::vector<HardMesh> meshes;
  for (const char* name : {"bunny_watertight_29k_fcpw.obj", "armadillo_libigl.obj",
                           "dragon_watertight_100k_fcpw.obj"}) {
    if (const auto file = test::shared_data(std::string("meshes/") + name)) {
      Mesh mesh = geometry::read_mesh(*file);
      Eigen::AlignedBox3d box;
      for (const Vector3d& v : mesh.vertices) {
        box.extend(v);
      }
      for (Vector3d& v : mesh.vertices) {
        v = (v - box.center()) / box.sizes().maxCoeff();
      }
      meshes.push_back({name, std::move(mesh)});
    }
  }
  return meshes;
}

}  // namespace haptrial::contact
