#include "core/geometry/volume/mesh_repair.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/base/error.h"
#include "core/base/random.h"
#include "core/geometry/mesh/mesh_size.h"
#include "core/geometry/mesh/procedural.h"
#include "core/geometry/volume/mesh_check.h"

namespace haptrial::geometry::mesh_repair_test {
namespace {

/// Every triangle with vertices of its own, as STL has them, each moved by up to `noise`.
Mesh soup(const Mesh& mesh, double noise) {
  RandomStream random(1, "soup");
  Mesh apart;
  for (const Triangle& t : mesh.triangles) {
    const auto first = static_cast<std::int32_t>(apart.vertices.size());
    for (const std::int32_t corner : t) {
      const Eigen::Vector3d any(random.normal(), random.normal(), random.normal());
      apart.vertices.push_back(mesh.vertices[corner] + noise * random.uniform() * any.normalized());
    }
    apart.triangles.push_back({first, first + 1, first + 2});
  }
  return apart;
}

Mesh inverted(Mesh mesh) {
  for (Triangle& t : mesh.triangles) {
    std::swap(t[1], t[2]);
  }
  return mesh;
}

Mesh joined(Mesh a, const Mesh& b) {
  const auto count = static_cast<std::int32_t>(a.vertices.size());
  a.vertices.insert(a.vertices.end(), b.vertices.begin(), b.vertices.end());
  for (const Triangle& t : b.triangles) {
    a.triangles.push_back({t[0] + count, t[1] + count, t[2] + count});
  }
  return a;
}

TEST(WeldTest, EqualCornersMakeTheMeshClosedAgain) {
  const Mesh sphere = make_sphere(1.0, 8);
  Mesh mesh = soup(sphere, 0.0);
  EXPECT_EQ(weld(mesh, 0.0), 3 * sphere.triangles.size() - sphere.vertices.size());
  const MeshReport r = check_mesh(mesh);
  EXPECT_EQ(r.vertices, sphere.vertices.size());
  EXPECT_TRUE(r.closed && r.manifold() && r.oriented());
}

TEST(WeldTest, ToleranceJoinsWhatIsNearAndMovesNothingFarther) {
  const Mesh sphere = make_sphere(1.0, 8);  // edges of about 0.13
  for (const double noise : {1e-9, 1e-4, 5e-3}) {
    const Mesh before = soup(sphere, noise);
    Mesh mesh = before;
    weld(mesh, 2.0 * noise);
    EXPECT_EQ(mesh.vertices.size(), sphere.vertices.size());
    EXPECT_TRUE(check_mesh(mesh).closed);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      for (std::size_t c = 0; c < 3; ++c) {
        const Eigen::Vector3d moved =
            mesh.vertices[mesh.triangles[t][c]] - before.vertices[before.triangles[t][c]];
        ASSERT_LE(moved.norm(), 2.0 * noise);
      }
    }
  }
}

TEST(WeldTest, KeptVerticesLieFartherApartThanTheTolerance) {
  RandomStream random(2, "points");
  Mesh mesh;
  for (int i = 0; i < 600; ++i) {
    mesh.vertices.push_back({random.uniform(), random.uniform(), 0.1 * random.uniform()});
  }
  weld(mesh, 0.1);
  ASSERT_GT(mesh.vertices.size(), 20u);
  for (std::size_t a = 0; a < mesh.vertices.size(); ++a) {
    for (std::size_t b = a + 1; b < mesh.vertices.size(); ++b) {
      ASSERT_GT((mesh.vertices[a] - mesh.vertices[b]).norm(), 0.1);
    }
  }
}

TEST(WeldTest, ATinyToleranceFarAwayIsHarmless) {
  Mesh mesh{{{1e12, 0, 0}, {1e12, 0, 0}, {-1e12, 1, 0}}, {{0, 1, 2}}};
  EXPECT_EQ(weld(mesh, 1e-300), 1u);
}

TEST(RepairTest, AFlatTriangleGoesWithoutMakingAHole) {
  // A tetrahedron with a vertex on one of its edges: one side knows of it, the other bridges it
  // with a triangle without area.
  Mesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.5, 0, 0}},
            {{0, 2, 4}, {4, 2, 1}, {0, 4, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
  ASSERT_TRUE(check_mesh(mesh).closed);
  ASSERT_EQ(check_mesh(mesh).flat_triangles, 1u);
  EXPECT_EQ(remove_degenerate(mesh), 1u);
  const MeshReport r = check_mesh(mesh);
  EXPECT_EQ(r.flat_triangles, 0u);
  EXPECT_TRUE(r.closed && r.manifold() && r.oriented());
  EXPECT_DOUBLE_EQ(r.volume, 1.0 / 6.0);
}

TEST(RepairTest, DegenerateDuplicateAndUnreferencedPartsGo) {
  const Mesh sphere = make_sphere(1.0, 4);
  Mesh mesh = sphere;
  mesh.vertices.insert(mesh.vertices.begin(), {9, 9, 9});
  for (Triangle& t : mesh.triangles) {
    for (std::int32_t& corner : t) {
      ++corner;
    }
  }
  mesh.triangles.push_back({5, 5, 6});
  mesh.triangles.push_back(
      {mesh.triangles[3][1], mesh.triangles[3][0], mesh.triangles[3][2]});  // the other way round
  const RepairReport r = repair(mesh);
  EXPECT_EQ(r.degenerate_triangles, 1u);
  EXPECT_EQ(r.duplicate_triangles, 1u);
  EXPECT_EQ(r.unreferenced_vertices, 1u);
  EXPECT_EQ(r.turned_triangles, 0u);
  EXPECT_EQ(mesh.triangles, sphere.triangles);
  EXPECT_EQ(mesh.vertices, sphere.vertices);
}

TEST(RepairTest, AMeshThatIsSoundStaysAsItIs) {
  for (const Mesh& sound : {make_gear(), make_torus(1, 0.3, 9, 7), make_rough_solid(1, 9, 2)}) {
    Mesh mesh = sound;
    repair(mesh);
    EXPECT_EQ(mesh.triangles, sound.triangles);
    EXPECT_EQ(mesh.vertices, sound.vertices);
  }
}

TEST(OrientTest, RandomTurnsAreUndone) {
  const Mesh torus = make_torus(1.0, 0.4, 20, 12);
  Mesh mesh = torus;
  RandomStream random(3, "turns");
  for (Triangle& t : mesh.triangles) {
    if (random.below(2) == 0) {
      std::swap(t[1], t[2]);
    }
  }
  EXPECT_GT(orient(mesh), 100u);
  const MeshReport r = check_mesh(mesh);
  EXPECT_TRUE(r.oriented());
  EXPECT_NEAR(r.volume, signed_volume(torus), 1e-12);
}

TEST(OrientTest, CavitiesLookInwardsAndWhatFloatsInThemOutwards) {
  const Mesh shells = joined(joined(inverted(make_sphere(3.0, 8)), make_sphere(2.0, 8)),
                             inverted(make_sphere(1.0, 8)));
  Mesh mesh = shells;
  orient(mesh);
  const double unit = signed_volume(make_sphere(1.0, 8));
  EXPECT_NEAR(signed_volume(mesh), (27.0 - 8.0 + 1.0) * unit, 1e-9);
}

TEST(FacingTest, EachComponentCountsAndCavitiesDoNot) {
  const auto beside = [](Mesh mesh) {
    for (Eigen::Vector3d& vertex : mesh.vertices) {
      vertex.x() += 9.0;
    }
    return mesh;
  };
  const Mesh large = make_sphere(3.0, 8);
  const Mesh small = make_sphere(1.0, 8);
  EXPECT_EQ(facing(joined(large, beside(small))), Facing::kOutwards);
  EXPECT_EQ(facing(joined(large, beside(inverted(small)))), Facing::kMixed);
  EXPECT_EQ(facing(joined(inverted(large), beside(inverted(small)))), Facing::kInwards);
  EXPECT_EQ(facing(joined(large, inverted(small))), Facing::kOutwards) << "a cavity";
  EXPECT_EQ(facing(joined(inverted(large), small)), Facing::kInwards) << "a room with a ball in it";
}

TEST(FacingTest, FacesThatAreThereBothWaysLookNeitherWay) {
  Mesh both = make_gear();
  const Mesh other_way = inverted(both);
  both.triangles.insert(both.triangles.end(), other_way.triangles.begin(),
                        other_way.triangles.end());
  EXPECT_EQ(facing(both), Facing::kNeither);
  EXPECT_EQ(facing(joined(both, make_sphere(0.001, 4))), Facing::kOutwards) << "beside a solid";
}

TEST(OrientTest, PartsThatOverlapAllLookOutwards) {
  const Mesh sphere = make_sphere(1.0, 8);
  Mesh moved = sphere;
  for (Eigen::Vector3d& vertex : moved.vertices) {
    vertex += Eigen::Vector3d(0.3, 0.4, -0.5);
  }
  for (Mesh both : {joined(sphere, moved), joined(moved, sphere)}) {
    EXPECT_EQ(orient(both), 0u);
  }
}

TEST(OrientTest, OpenPiecesLookOutwardsFromTheirMiddle) {
  Mesh mesh = inverted(make_sphere(1.0, 8));
  mesh.triangles.resize(mesh.triangles.size() - 30);
  orient(mesh);
  EXPECT_TRUE(check_mesh(mesh).oriented());
  EXPECT_GT(signed_volume(mesh), 0.0);
}

TEST(RepairTest, NothingLeftIsASentence) {
  Mesh mesh{{{0, 0, 0}, {0, 0, 0}, {0, 0, 0}}, {{0, 1, 2}}};
  EXPECT_THROW(repair(mesh), InputError);
  Mesh sphere = make_sphere(1.0, 2);
  EXPECT_THROW(repair(sphere, {.weld_tolerance = -1.0}), std::invalid_argument);
  EXPECT_THROW(repair(sphere, {.weld_tolerance = std::nan("")}), std::invalid_argument);
}

}  // namespace
}  // namespace haptrial::geometry::mesh_repair_test
