#include "tests/support/references/neighbour_surface.h"

#include <gtest/gtest.h>

#include "tests/core/bone/surface/surface_checks.h"

namespace haptrial::bone {
namespace {

std::vector<SurfaceTriangle> triangles_of(const geometry::Mesh& mesh) {
  std::vector<SurfaceTriangle> all;
  for (const geometry::Triangle& t : mesh.triangles) {
    all.push_back({static_cast<std::uint32_t>(t[0]), static_cast<std::uint32_t>(t[1]),
                   static_cast<std::uint32_t>(t[2])});
  }
  return all;
}

TEST(NeighbourSurfaceTest, FourVoxelsMakeATetrahedronOrASquareTwice) {
  const auto made = [](auto&& label_of) {
    return triangles_of(NeighbourSurface(BoneVolume(model_of(8, label_of))).mesh());
  };
  const auto corner = made([](const Voxel& v) {
    const Voxel d = v - Voxel::Constant(3);
    return d.minCoeff() >= 0 && d.sum() <= 1;
  });
  EXPECT_EQ(corner.size(), 4U);
  EXPECT_EQ(open_edges(corner), 0);
  // Cost of the exhaustive way: all four triangles of three of a square's corners.
  const auto square = made([](const Voxel& v) {
    return v.z() == 3 && (v.x() == 3 || v.x() == 4) && (v.y() == 3 || v.y() == 4);
  });
  EXPECT_EQ(square.size(), 4U);
}

TEST(NeighbourSurfaceTest, OfABallItsTrianglesOverlapWhereOneVertexToACellIsClosed) {
  const BoneVolume volume(ball_model(24, 9.0));
  const NeighbourSurface theirs(volume);
  Surface ours;
  ours.update(volume);
  EXPECT_GT(branching_edges(triangles_of(theirs.mesh())), 0);
  EXPECT_EQ(branching_edges(ours.triangles()), 0);
}

}  // namespace
}  // namespace haptrial::bone
