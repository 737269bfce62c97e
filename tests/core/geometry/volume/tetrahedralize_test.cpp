#include "core/geometry/volume/tetrahedralize.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <set>

#include "core/base/error.h"
#include "core/base/random.h"
#include "core/geometry/mesh/procedural.h"
#include "core/geometry/volume/voxelize.h"

namespace haptrial::geometry {
namespace {

using Face = std::array<std::int32_t, 3>;

VoxelSolid random_solid(std::array<std::int32_t, 3> size, double share, std::uint64_t seed) {
  VoxelGrid grid{size, {0.25, -3.0, 7.5}, 0.5};
  RandomStream random(seed, "solid");
  VoxelSolid solid{grid, {}};
  for (std::size_t v = 0; v < grid.count(); ++v) {
    const double draw = random.uniform();
    solid.labels.push_back(draw < share         ? VoxelLabel::kInside
                           : draw < share + 0.1 ? VoxelLabel::kBorder
                                                : VoxelLabel::kOutside);
  }
  return solid;
}

double sixfold_volume(const TetMesh& mesh, const Tetrahedron& t) {
  const Eigen::Vector3d& a = mesh.vertices[t[0]];
  return (mesh.vertices[t[1]] - a).dot((mesh.vertices[t[2]] - a).cross(mesh.vertices[t[3]] - a));
}

/// How many tetrahedra have each face.
std::map<Face, int> faces_of(const TetMesh& mesh) {
  std::map<Face, int> faces;
  for (const Tetrahedron& t : mesh.tetrahedra) {
    for (std::size_t left_out = 0; left_out < 4; ++left_out) {
      Face face{};
      std::size_t corner = 0;
      for (std::size_t c = 0; c < 4; ++c) {
        if (c != left_out) {
          face[corner++] = t[c];
        }
      }
      std::sort(face.begin(), face.end());
      ++faces[face];
    }
  }
  return faces;
}

/// Vertices, edges, faces and cells of the voxels themselves: the Euler characteristic of the
/// solid that they fill, found without any tetrahedron.
long voxel_euler(const VoxelSolid& solid) {
  std::set<std::array<std::int32_t, 3>> cells;  // by doubled middle
  for (std::int32_t k = 0; k < solid.grid.size[2]; ++k) {
    for (std::int32_t j = 0; j < solid.grid.size[1]; ++j) {
      for (std::int32_t i = 0; i < solid.grid.size[0]; ++i) {
        if (solid.labels[solid.grid.index(i, j, k)] == VoxelLabel::kInside) {
          for (int n = 0; n < 27; ++n) {
            cells.insert({2 * i + n % 3, 2 * j + n / 3 % 3, 2 * k + n / 9});
          }
        }
      }
    }
  }
  long sum = 0;
  for (const auto& cell : cells) {
    const int odd = (cell[0] & 1) + (cell[1] & 1) + (cell[2] & 1);  // the cell's dimension
    sum += odd % 2 == 0 ? 1 : -1;
  }
  return sum;
}

long tet_euler(const TetMesh& mesh, const std::map<Face, int>& faces) {
  std::set<std::pair<std::int32_t, std::int32_t>> edges;
  for (const auto& [face, count] : faces) {
    edges.insert({face[0], face[1]});
    edges.insert({face[1], face[2]});
    edges.insert({face[0], face[2]});
  }
  return static_cast<long>(mesh.vertices.size()) - static_cast<long>(edges.size()) +
         static_cast<long>(faces.size()) - static_cast<long>(mesh.tetrahedra.size());
}

class TetrahedralizeTest : public ::testing::TestWithParam<VoxelSolid> {};

TEST_P(TetrahedralizeTest, FillsTheVoxelsWithoutAnInvertedElement) {
  const VoxelSolid& solid = GetParam();
  const TetMesh mesh = tetrahedralize(solid);
  const std::size_t inside = count_inside(solid);
  ASSERT_EQ(mesh.tetrahedra.size(), 5 * inside);
  const double voxel = std::pow(solid.grid.spacing, 3);
  double total = 0.0;
  for (const Tetrahedron& t : mesh.tetrahedra) {
    const double volume = sixfold_volume(mesh, t) / 6.0;
    ASSERT_GT(volume, 0.16 * voxel) << "a sixth or a third of a voxel, never inverted";
    total += volume;
  }
  EXPECT_NEAR(total, static_cast<double>(inside) * voxel, 1e-9 * total);
}

TEST_P(TetrahedralizeTest, NeighboursShareWholeFacesAndTheSurfaceIsTagged) {
  const VoxelSolid& solid = GetParam();
  const TetMesh mesh = tetrahedralize(solid);
  std::size_t exposed = 0;  // sides of inside voxels without an inside neighbour
  const VoxelGrid& g = solid.grid;
  const auto inside = [&](std::int32_t i, std::int32_t j, std::int32_t k) {
    return i >= 0 && j >= 0 && k >= 0 && i < g.size[0] && j < g.size[1] && k < g.size[2] &&
           solid.labels[g.index(i, j, k)] == VoxelLabel::kInside;
  };
  for (std::int32_t k = 0; k < g.size[2]; ++k) {
    for (std::int32_t j = 0; j < g.size[1]; ++j) {
      for (std::int32_t i = 0; i < g.size[0]; ++i) {
        if (inside(i, j, k)) {
          exposed += !inside(i - 1, j, k) + !inside(i + 1, j, k) + !inside(i, j - 1, k) +
                     !inside(i, j + 1, k) + !inside(i, j, k - 1) + !inside(i, j, k + 1);
        }
      }
    }
  }
  std::vector<std::uint8_t> on_surface(mesh.vertices.size(), 0);
  std::size_t single = 0;
  const std::map<Face, int> faces = faces_of(mesh);
  for (const auto& [face, count] : faces) {
    ASSERT_TRUE(count == 1 || count == 2);
    if (count == 1) {
      ++single;
      for (const std::int32_t corner : face) {
        on_surface[corner] = 1;
      }
    }
  }
  EXPECT_EQ(single, 2 * exposed) << "any face that does not match would be single too";
  EXPECT_TRUE(std::equal(on_surface.begin(), on_surface.end(), mesh.on_surface.begin(),
                         mesh.on_surface.end()));
  EXPECT_EQ(tet_euler(mesh, faces), voxel_euler(solid));
}

TEST_P(TetrahedralizeTest, VerticesAreSharedAndAllUsed) {
  const TetMesh mesh = tetrahedralize(GetParam());
  std::set<std::array<double, 3>> places;
  for (const Eigen::Vector3d& v : mesh.vertices) {
    places.insert({v.x(), v.y(), v.z()});
  }
  EXPECT_EQ(places.size(), mesh.vertices.size()) << "no place twice";
  std::vector<bool> used(mesh.vertices.size(), false);
  for (const Tetrahedron& t : mesh.tetrahedra) {
    for (const std::int32_t corner : t) {
      used.at(static_cast<std::size_t>(corner)) = true;
    }
  }
  EXPECT_TRUE(std::all_of(used.begin(), used.end(), [](bool b) { return b; }));
}

VoxelSolid full(std::array<std::int32_t, 3> size) {
  VoxelSolid solid = random_solid(size, 1.1, 1);
  return solid;
}

VoxelSolid torus() {
  const Mesh mesh = make_torus(1.0, 0.4, 40, 20);
  return voxelize(mesh, make_grid(bounds(mesh), 24), InsideRule::kParity);
}

// Rows of 63, 64 and 65 voxels end at, before and behind the end of a machine word.
INSTANTIATE_TEST_SUITE_P(Solids, TetrahedralizeTest,
                         ::testing::Values(full({1, 1, 1}), full({4, 3, 2}), full({64, 2, 2}),
                                           random_solid({7, 9, 8}, 0.3, 2),
                                           random_solid({63, 3, 4}, 0.7, 3),
                                           random_solid({64, 4, 3}, 0.9, 4),
                                           random_solid({65, 3, 3}, 0.5, 5),
                                           random_solid({130, 3, 3}, 0.97, 6), torus()));

TEST(TetrahedralizeTableTest, ATorusOfVoxelsHasTheEulerCharacteristicOfATorus) {
  const VoxelSolid solid = torus();
  const TetMesh mesh = tetrahedralize(solid);
  EXPECT_EQ(tet_euler(mesh, faces_of(mesh)), 0);
}

TEST(TetrahedralizeTableTest, TheCornersOfAVoxelLieHalfAVoxelAroundItsCentre) {
  const TetMesh mesh = tetrahedralize(full({1, 1, 1}));
  ASSERT_EQ(mesh.vertices.size(), 8u);
  EXPECT_EQ(mesh.vertices.front(), Eigen::Vector3d(0.0, -3.25, 7.25));
  EXPECT_EQ(mesh.vertices.back(), Eigen::Vector3d(0.5, -2.75, 7.75));
}

TEST(TetrahedralizeTableTest, MemoryIsUsedAgain) {
  TetMesh mesh;
  tetrahedralize(full({20, 20, 20}), mesh);
  const Tetrahedron* before = mesh.tetrahedra.data();
  tetrahedralize(full({19, 20, 20}), mesh);
  EXPECT_EQ(mesh.tetrahedra.data(), before);
  EXPECT_EQ(mesh.tetrahedra.size(), 5u * 19 * 20 * 20);
}

TEST(TetrahedralizeTableTest, NothingInsideIsRefused) {
  EXPECT_THROW(tetrahedralize(random_solid({5, 5, 5}, -1.0, 1)), InputError);
}

TEST(TetrahedralizeTableTest, TheMemoryThatIsForeseenIsEnough) {
  for (const auto& solid : {full({30, 20, 10}), random_solid({30, 20, 10}, 0.2, 3)}) {
    const TetMesh mesh = tetrahedralize(solid);
    const double taken = 25.0 * static_cast<double>(mesh.vertices.size()) +
                         16.0 * static_cast<double>(mesh.tetrahedra.size());
    EXPECT_LE(taken, tetrahedralizing_memory(solid.grid, count_inside(solid)));
    EXPECT_GT(taken, 0.3 * tetrahedralizing_memory(solid.grid, count_inside(solid)));
  }
}

}  // namespace
}  // namespace haptrial::geometry
