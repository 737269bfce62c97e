#include "core/geometry/volume/mesh_check.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/geometry/mesh/procedural.h"

namespace haptrial::geometry::mesh_check_test {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

Mesh joined(const Mesh& a, const Mesh& b) {
  Mesh both = a;
  const auto count = static_cast<std::int32_t>(a.vertices.size());
  both.vertices.insert(both.vertices.end(), b.vertices.begin(), b.vertices.end());
  for (const Triangle& t : b.triangles) {
    both.triangles.push_back({t[0] + count, t[1] + count, t[2] + count});
  }
  return both;
}

Mesh moved(Mesh mesh, const Eigen::Vector3d& by) {
  for (Eigen::Vector3d& v : mesh.vertices) {
    v += by;
  }
  return mesh;
}

Mesh tetrahedron() {
  return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
          {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
}

/// A band of n quadrilaterals, with half a turn or without.
Mesh band(std::int32_t n, bool twisted) {
  Mesh mesh;
  for (std::int32_t i = 0; i < n; ++i) {
    const double u = 2.0 * M_PI * i / n;
    const double turn = twisted ? 0.5 * u : 0.0;
    const Eigen::Vector3d out(std::cos(u), std::sin(u), 0.0);
    const Eigen::Vector3d across =
        0.3 * (std::sin(turn) * out + std::cos(turn) * Eigen::Vector3d::UnitZ());
    mesh.vertices.push_back(out - across);
    mesh.vertices.push_back(out + across);
  }
  for (std::int32_t i = 0; i < n; ++i) {
    const bool last = i + 1 == n && twisted;
    const std::int32_t a = 2 * i, b = 2 * i + 1;
    const std::int32_t c = (2 * i + (last ? 3 : 2)) % (2 * n);
    const std::int32_t d = (2 * i + (last ? 2 : 3)) % (2 * n);
    mesh.triangles.push_back({a, c, b});
    mesh.triangles.push_back({b, c, d});
  }
  return mesh;
}

TEST(MeshCheckTest, ATetrahedronIsTheLeastClosedMesh) {
  const MeshReport r = check_mesh(tetrahedron());
  EXPECT_TRUE(r.closed && r.manifold() && r.oriented());
  EXPECT_EQ(r.edges, 6u);
  EXPECT_EQ(r.genus, 0u);
  EXPECT_DOUBLE_EQ(r.volume, 1.0 / 6.0);
  EXPECT_DOUBLE_EQ(r.area, 1.5 + std::sqrt(3.0) / 2.0);
  EXPECT_EQ(r.box.max(), Eigen::Vector3d(1, 1, 1));
}

TEST(MeshCheckTest, PiecesAndHandlesAddUp) {
  const Mesh torus = make_torus(1.0, 0.3, 12, 8);
  const Mesh two = joined(torus, moved(torus, {5, 0, 0}));
  const MeshReport r = check_mesh(joined(two, moved(make_gear(), {0, 9, 0})));
  EXPECT_EQ(r.components, 3u);
  EXPECT_EQ(r.genus, 3u);
}

TEST(MeshCheckTest, HolesAreCountedEdgeByEdgeAndLoopByLoop) {
  Mesh mesh = make_sphere(1.0, 6);
  mesh.triangles.erase(mesh.triangles.begin() + 300);
  mesh.triangles.erase(mesh.triangles.begin());
  const MeshReport r = check_mesh(mesh);
  EXPECT_FALSE(r.closed);
  EXPECT_EQ(r.boundary_edges, 6u);
  EXPECT_EQ(r.boundary_loops, 2u);
  EXPECT_EQ(r.genus, 0u) << "a sphere with holes";
  EXPECT_THAT(describe(r), Contains(HasSubstr("open: 6 boundary edges in 2 loops")));
}

TEST(MeshCheckTest, ASurfaceWithoutBoundaryMayBeNotClosed) {
  Mesh mesh = tetrahedron();
  mesh.triangles.push_back(mesh.triangles[0]);
  const MeshReport r = check_mesh(mesh);
  EXPECT_FALSE(r.closed);
  EXPECT_EQ(r.odd_edges, 3u);
  EXPECT_THAT(describe(r), Contains(HasSubstr("not closed: 3 edges of three triangles")));
}

TEST(MeshCheckTest, HolesThatMeetAtAVertexAreOneLoopEachSide) {
  Mesh mesh = make_sphere(1.0, 4);
  const std::int32_t shared = mesh.triangles[0][0];
  // Two triangles around one vertex that share no edge.
  std::size_t second = 0;
  for (std::size_t t = 1; t < mesh.triangles.size() && second == 0; ++t) {
    int in_common = 0;
    bool touches = false;
    for (const std::int32_t a : mesh.triangles[t]) {
      touches = touches || a == shared;
      for (const std::int32_t b : mesh.triangles[0]) {
        in_common += a == b;
      }
    }
    second = touches && in_common == 1 ? t : 0;
  }
  ASSERT_GT(second, 0u);
  mesh.triangles.erase(mesh.triangles.begin() + static_cast<std::ptrdiff_t>(second));
  mesh.triangles.erase(mesh.triangles.begin());
  const MeshReport r = check_mesh(mesh);
  EXPECT_EQ(r.boundary_edges, 6u);
  EXPECT_EQ(r.nonmanifold_vertices, 1u);
  EXPECT_EQ(r.genus, 0u);
}

TEST(MeshCheckTest, ABandIsOrientableUnlessItIsTwisted) {
  const MeshReport plain = check_mesh(band(20, false));
  EXPECT_EQ(plain.boundary_loops, 2u);
  EXPECT_EQ(plain.genus, 0u);
  EXPECT_EQ(plain.one_sided_components, 0u);
  const MeshReport twisted = check_mesh(band(20, true));
  EXPECT_EQ(twisted.boundary_loops, 1u);
  EXPECT_EQ(twisted.one_sided_components, 1u);
  EXPECT_EQ(twisted.genus, std::nullopt);
  EXPECT_FALSE(twisted.oriented());
}

TEST(MeshCheckTest, SolidsThatTouchAtAVertexOrAnEdgeAreTold) {
  Mesh vertex = joined(tetrahedron(), tetrahedron());
  for (std::size_t v = 5; v < 8; ++v) {
    vertex.vertices[v] = -vertex.vertices[v];
  }
  for (std::size_t t = 4; t < 8; ++t) {
    for (std::int32_t& corner : vertex.triangles[t]) {
      corner = corner == 4 ? 0 : corner;
    }
    std::swap(vertex.triangles[t][0], vertex.triangles[t][1]);
  }
  const MeshReport at_vertex = check_mesh(vertex);
  EXPECT_EQ(at_vertex.nonmanifold_vertices, 1u);
  EXPECT_EQ(at_vertex.unreferenced_vertices, 1u);
  EXPECT_EQ(at_vertex.components, 2u) << "joined through edges only";
  EXPECT_EQ(at_vertex.genus, 0u);
  EXPECT_DOUBLE_EQ(at_vertex.volume, 2.0 / 6.0);

  Mesh edge = joined(tetrahedron(), tetrahedron());
  for (std::size_t t = 4; t < 8; ++t) {  // shares the edge from 0 to 3
    for (std::int32_t& corner : edge.triangles[t]) {
      corner = corner == 4 ? 0 : corner == 7 ? 3 : corner;
    }
  }
  const MeshReport at_edge = check_mesh(edge);
  EXPECT_EQ(at_edge.nonmanifold_edges, 1u);
  EXPECT_TRUE(at_edge.closed) << "four triangles around an edge are an even number";
  EXPECT_EQ(at_edge.genus, std::nullopt);
}

TEST(MeshCheckTest, FlawsAreCounted) {
  Mesh mesh = tetrahedron();
  mesh.vertices.push_back({0.5, 0.0, 0.0});
  mesh.vertices.push_back({7.0, 7.0, 7.0});
  mesh.triangles.push_back({0, 0, 1});
  mesh.triangles.push_back({0, 4, 1});  // 4 lies between 0 and 1
  mesh.triangles.push_back({1, 2, 0});  // the first one's corners
  const MeshReport r = check_mesh(mesh);
  EXPECT_EQ(r.repeated_corner_triangles, 1u);
  EXPECT_EQ(r.flat_triangles, 1u);
  EXPECT_EQ(r.duplicate_triangles, 1u);
  EXPECT_EQ(r.unreferenced_vertices, 1u);
  EXPECT_EQ(r.nonmanifold_edges, 3u);
  EXPECT_THAT(describe(r), Contains(HasSubstr("1 triangle without area")));
}

TEST(MeshCheckTest, AFaceThatIsTurnedIsFound) {
  Mesh mesh = make_sphere(1.0, 3);
  std::swap(mesh.triangles[10][0], mesh.triangles[10][1]);
  const MeshReport r = check_mesh(mesh);
  EXPECT_EQ(r.disagreeing_edges, 3u);
  EXPECT_TRUE(r.closed);
  EXPECT_FALSE(r.oriented());
  EXPECT_EQ(r.one_sided_components, 0u);
}

TEST(MeshCheckTest, WhereFacesOfAnOpenOrTwoSidedMeshLookIsTold) {
  Mesh open = make_sphere(1.0, 6);
  open.triangles.pop_back();
  EXPECT_THAT(describe(check_mesh(open)), Contains(HasSubstr("in 1 loop, faces look outwards")));
  Mesh turned = open;
  for (Triangle& t : turned.triangles) {
    std::swap(t[0], t[1]);
  }
  EXPECT_THAT(describe(check_mesh(turned)), Contains(HasSubstr("in 1 loop, faces look inwards")));
  const Mesh sheet{{{0, 0, 0}, {1, 0, 0.3}, {0, 1, 0.1}}, {{0, 1, 2}}};
  EXPECT_THAT(describe(check_mesh(sheet)), testing::Not(Contains(HasSubstr("look"))));
  open.triangles.insert(open.triangles.end(), turned.triangles.begin(), turned.triangles.end());
  const MeshReport both = check_mesh(open);
  EXPECT_EQ(both.facing, Facing::kNeither);
  EXPECT_THAT(describe(both), Contains(HasSubstr("so that nothing is inside")));
}

TEST(MeshCheckTest, AMeshOfNothingButRepeatedCornersHasNoSurface) {
  const MeshReport r = check_mesh({{{0, 0, 0}}, {{0, 0, 0}}});
  EXPECT_FALSE(r.closed);
  EXPECT_EQ(r.components, 0u);
  EXPECT_THAT(describe(r), Contains(HasSubstr("no surface")));
}

}  // namespace
}  // namespace haptrial::geometry::mesh_check_test
