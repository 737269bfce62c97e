#include "core/deformable/body/mesh_parts.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <set>

#include "tests/support/message_of.h"
#include "tests/support/solid_block.h"

namespace haptrial::deformable {
namespace {

using Eigen::Vector3d;
using geometry::TetMesh;
using geometry::Tetrahedron;

/// Half the sum of the faces' corners' triple products is three times what they enclose.
double enclosed(const TetMesh& body, const std::vector<Face>& surface) {
  double six = 0;
  for (const Face& face : surface) {
    const auto at = [&](std::size_t i) -> const Vector3d& {
      return body.vertices[static_cast<std::size_t>(face[i])];
    };
    six += at(0).dot(at(1).cross(at(2)));
  }
  return six / 6;
}

TEST(MeshPartsTest, OfOneTetrahedron) {
  const std::vector<Tetrahedron> one{{0, 1, 2, 3}};
  const MeshParts parts = mesh_parts(one);
  EXPECT_EQ(parts.edges.size(), 6u);
  EXPECT_EQ(parts.faces.size(), 4u);
  EXPECT_EQ(parts.surface.size(), 4u);
}

TEST(MeshPartsTest, ObeyEulerAndTheDivergenceTheorem) {
  const TetMesh body = test::solid_block({3, 4, 2}, 0.01);
  const MeshParts parts = mesh_parts(body.tetrahedra);
  const auto count = [](const auto& list) { return static_cast<long>(list.size()); };
  EXPECT_EQ(count(body.vertices) - count(parts.edges) + count(parts.faces) - count(body.tetrahedra),
            1);  // a ball
  EXPECT_EQ(2 * parts.faces.size() - parts.surface.size(), 4 * body.tetrahedra.size());
  EXPECT_EQ(parts.surface.size(), 2u * 2 * (3 * 4 + 3 * 2 + 4 * 2));
  EXPECT_NEAR(enclosed(body, parts.surface), 24e-6, 1e-18);
  const std::set<Edge> distinct(parts.edges.begin(), parts.edges.end());
  EXPECT_EQ(distinct.size(), parts.edges.size());
}

TEST(MeshPartsTest, OuterFacesHaveTheVerticesOnTheSurface) {
  const TetMesh body = test::solid_block({3, 3, 3}, 0.01);
  std::set<std::int32_t> seen;
  for (const Face& face : mesh_parts(body.tetrahedra).surface) {
    seen.insert(face.begin(), face.end());
  }
  for (std::size_t v = 0; v < body.vertices.size(); ++v) {
    EXPECT_EQ(seen.contains(static_cast<std::int32_t>(v)), body.on_surface[v] == 1) << v;
  }
}

TEST(MeshPartsTest, RefuseAFaceOfThree) {
  const std::vector<Tetrahedron> fan{{0, 1, 2, 3}, {0, 2, 1, 4}, {0, 1, 2, 5}};
  EXPECT_EQ(test::message_of([&] { mesh_parts(fan); }),
            "tetrahedra: 3 share the face of vertices 0, 1 and 2; at most 2 may");
}

TEST(ConnectedPartsTest, AreNumberedByTheirFirstVertex) {
  const std::vector<Tetrahedron> two{{5, 6, 7, 4}, {1, 2, 3, 0}};
  EXPECT_THAT(connected_parts(two, 9), testing::ElementsAre(0, 0, 0, 0, 1, 1, 1, 1, 2));
}

}  // namespace
}  // namespace haptrial::deformable
