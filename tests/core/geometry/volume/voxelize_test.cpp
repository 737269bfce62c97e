#include "core/geometry/volume/voxelize.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <deque>

#include "core/base/error.h"
#include "core/base/instruction_set.h"
#include "core/base/random.h"
#include "core/geometry/files/mesh_io.h"
#include "core/geometry/mesh/procedural.h"
#include "core/geometry/volume/boundary_cone.h"
#include "core/geometry/volume/grid_crossings.h"
#include "core/geometry/volume/mesh_check.h"
#include "tests/support/shared_data.h"

namespace haptrial::geometry {
namespace {

std::vector<bool> inside(const VoxelSolid& solid) {
  std::vector<bool> flags;
  for (const VoxelLabel label : solid.labels) {
    flags.push_back(label == VoxelLabel::kInside);
  }
  return flags;
}

/// Answer of `rule(centre)` for every voxel.
template <class Rule>
std::vector<bool> each_centre(const VoxelGrid& grid, const Rule& rule) {
  std::vector<bool> flags;
  for (std::int32_t k = 0; k < grid.size[2]; ++k) {
    for (std::int32_t j = 0; j < grid.size[1]; ++j) {
      for (std::int32_t i = 0; i < grid.size[0]; ++i) {
        flags.push_back(rule(grid.centre(i, j, k)));
      }
    }
  }
  return flags;
}

VoxelGrid grid_for(const Mesh& mesh, int resolution, int margin = 0) {
  return make_grid(bounds(mesh), resolution, margin);
}

/// A cube of side 2 around the origin, its faces on planes of grid centres where those are whole.
Mesh cube() {
  Mesh mesh;
  for (int c = 0; c < 8; ++c) {
    mesh.vertices.emplace_back(c % 2 * 2 - 1, c / 2 % 2 * 2 - 1, c / 4 * 2 - 1);
  }
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

TEST(VoxelGridTest, TheLongestSideHasTheResolution) {
  const Eigen::AlignedBox3d box(Eigen::Vector3d(-1, 0, 5), Eigen::Vector3d(3, 2, 5.5));
  const VoxelGrid grid = make_grid(box, 10, 1);
  EXPECT_EQ(grid.size, (std::array<std::int32_t, 3>{12, 7, 4}));
  EXPECT_DOUBLE_EQ(grid.spacing, 0.4);
  EXPECT_TRUE(grid.origin.isApprox(Eigen::Vector3d(-1.2, -0.2, 4.65)));
  EXPECT_EQ(make_grid({Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(0.3, 0.1, 0.2)}, 3).size,
            (std::array<std::int32_t, 3>{3, 1, 2}))
      << "whole numbers in spite of rounding";
}

TEST(VoxelGridTest, BadGridsAreRefused) {
  const Eigen::AlignedBox3d box(Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(1, 1, 1));
  EXPECT_THROW(make_grid(box, 0), InputError);
  EXPECT_THROW(make_grid(box, 20001), InputError);
  EXPECT_THROW(make_grid({}, 5), InputError);
  EXPECT_THROW(make_grid({Eigen::Vector3d(1, 1, 1), Eigen::Vector3d(1, 1, 1)}, 5), InputError);
  EXPECT_THROW(make_grid({Eigen::Vector3d(1e12, 0, 0), Eigen::Vector3d(1e12 + 1, 1, 1)}, 5),
               InputError);
}

TEST(GridCrossingsTest, EveryAxisSaysTheSameOfEveryCentre) {
  // Coordinates that hit grid lines and centres: ties of every kind.
  for (const int resolution : {2, 3, 4, 8}) {
    for (const Mesh& mesh : {cube(), make_torus(2.0, 1.0, 8, 4), make_gear()}) {
      const VoxelGrid grid = grid_for(mesh, resolution, 1);
      std::array<std::vector<bool>, 3> by_axis;
      for (int axis = 0; axis < 3; ++axis) {
        by_axis[axis].assign(grid.count(), false);
        const GridCrossings crossings(mesh, grid, axis);
        for (std::int32_t k = 0; k < grid.size[2]; ++k) {
          for (std::int32_t j = 0; j < grid.size[1]; ++j) {
            for (std::int32_t i = 0; i < grid.size[0]; ++i) {
              const std::array<std::int32_t, 3> at{i, j, k};
              const int u = (axis + 1) % 3;
              const int v = (axis + 2) % 3;
              int before = 0;
              for (const Crossing& c :
                   crossings.on_line(static_cast<std::size_t>(at[u] + grid.size[u] * at[v]))) {
                before += c.before <= at[axis];
              }
              by_axis[axis][grid.index(i, j, k)] = before % 2 == 1;
            }
          }
        }
      }
      EXPECT_EQ(by_axis[0], by_axis[1]);
      EXPECT_EQ(by_axis[0], by_axis[2]);
      EXPECT_EQ(by_axis[0], inside(voxelize(mesh, grid, InsideRule::kParity)));
    }
  }
}

TEST(GridCrossingsTest, ACentreOnAFaceCountsAsIfItWereShiftedUp) {
  VoxelGrid grid{{3, 3, 3}, {-1.0, -1.0, -1.0}, 1.0};  // centres at -1, 0, 1: all on the cube
  const VoxelSolid solid = voxelize(cube(), grid, InsideRule::kParity);
  const auto expected =
      each_centre(grid, [](const Eigen::Vector3d& c) { return c.maxCoeff() < 1; });
  EXPECT_EQ(inside(solid), expected) << "-1 is shifted inside, 1 outside";
}

TEST(VoxelizeTest, ASphereOfVoxelsHoldsTheCentresWithinItsRadius) {
  const Mesh mesh = make_sphere(1.0, 40);
  const VoxelSolid solid = voxelize(mesh, grid_for(mesh, 40), InsideRule::kParity);
  std::size_t wrong = 0;
  std::size_t index = 0;
  for (const bool near : each_centre(solid.grid, [](const auto& c) { return c.norm() < 0.9995; })) {
    wrong += near && solid.labels[index] != VoxelLabel::kInside;
    ++index;
  }
  EXPECT_EQ(wrong, 0u);
  index = 0;
  for (const bool far : each_centre(solid.grid, [](const auto& c) { return c.norm() > 1.0; })) {
    ASSERT_FALSE(far && solid.labels[index] == VoxelLabel::kInside);
    ++index;
  }
}

TEST(VoxelizeTest, ParityIsThatOfRays) {
  for (const Mesh& mesh :
       {make_gear(), make_torus(1.0, 0.3, 31, 17), make_rough_solid(1.0, 30, 5)}) {
    const VoxelSolid solid = voxelize(mesh, grid_for(mesh, 37, 1), InsideRule::kParity);
    const Bvh hierarchy(mesh);
    EXPECT_EQ(inside(solid), each_centre(solid.grid, [&](const Eigen::Vector3d& centre) {
                return hierarchy.contains(centre);
              }));
  }
}

/// A mesh and its copy, moved.
Mesh with_moved(const Mesh& mesh, const Eigen::Vector3d& by) {
  Mesh both = mesh;
  const auto count = static_cast<std::int32_t>(mesh.vertices.size());
  for (const Eigen::Vector3d& vertex : mesh.vertices) {
    both.vertices.push_back(vertex + by);
  }
  for (const Triangle& t : mesh.triangles) {
    both.triangles.push_back({t[0] + count, t[1] + count, t[2] + count});
  }
  return both;
}

/// The source's method to the letter: from a seed, a ray to each neighbour (§5.2.2).
std::vector<bool> flood_with_rays(const Mesh& mesh, const VoxelGrid& grid, std::size_t seed) {
  const Bvh hierarchy(mesh);
  std::vector<bool> reached(grid.count(), false);
  std::deque<std::array<std::int32_t, 3>> queue;
  const auto n = static_cast<std::size_t>(grid.size[0]);
  queue.push_back({static_cast<std::int32_t>(seed % n),
                   static_cast<std::int32_t>(seed / n % static_cast<std::size_t>(grid.size[1])),
                   static_cast<std::int32_t>(seed / n / static_cast<std::size_t>(grid.size[1]))});
  reached[seed] = true;
  while (!queue.empty()) {
    const auto at = queue.front();
    queue.pop_front();
    for (int side = 0; side < 6; ++side) {
      auto to = at;
      to[side / 2] += side % 2 == 0 ? 1 : -1;
      if (to[side / 2] < 0 || to[side / 2] >= grid.size[side / 2] ||
          reached[grid.index(to[0], to[1], to[2])]) {
        continue;
      }
      const Eigen::Vector3d from = grid.centre(at[0], at[1], at[2]);
      const Ray ray{from, grid.centre(to[0], to[1], to[2]) - from, 0.0, 1.0};
      if (!hierarchy.nearest_hit(ray)) {
        reached[grid.index(to[0], to[1], to[2])] = true;
        queue.push_back(to);
      }
    }
  }
  return reached;
}

TEST(VoxelizeTest, AFloodIsThatOfTheSource) {
  for (const Mesh& mesh :
       {make_gear(), make_torus(1.0, 0.2, 40, 20), make_rough_solid(1.0, 30, 6)}) {
    const VoxelGrid grid = grid_for(mesh, 33);
    const std::vector<bool> flooded = inside(voxelize(mesh, grid, InsideRule::kFlood));
    const auto seed = std::find(flooded.begin(), flooded.end(), true) - flooded.begin();
    EXPECT_EQ(flooded, flood_with_rays(mesh, grid, static_cast<std::size_t>(seed)));
    // Nothing is reached that parity does not know.
    const std::vector<bool> all = inside(voxelize(mesh, grid, InsideRule::kParity));
    for (std::size_t v = 0; v < all.size(); ++v) {
      ASSERT_TRUE(all[v] || !flooded[v]);
    }
  }
}

TEST(VoxelizeTest, AFloodFillsOneOfSeveralBodiesAndParityAll) {
  const Mesh mesh = with_moved(make_sphere(1.0, 6), {4, 0, 0});
  const VoxelGrid grid = grid_for(mesh, 60);
  const std::size_t both = count_inside(voxelize(mesh, grid, InsideRule::kParity));
  EXPECT_EQ(count_inside(voxelize(mesh, grid, InsideRule::kFlood)), both / 2);
}

/// The winding number by its definition, triangle by triangle.
double winding_number(const Mesh& mesh, const Eigen::Vector3d& point) {
  double sum = 0.0;
  for (const Triangle& t : mesh.triangles) {
    const Eigen::Vector3d a = (mesh.vertices[t[0]] - point).normalized();
    const Eigen::Vector3d b = (mesh.vertices[t[1]] - point).normalized();
    const Eigen::Vector3d c = (mesh.vertices[t[2]] - point).normalized();
    sum += 2.0 * std::atan2(a.dot(b.cross(c)), 1.0 + a.dot(b) + b.dot(c) + c.dot(a));
  }
  return sum / (4.0 * M_PI);
}

void expect_winding(const Mesh& mesh, int resolution, const char* what) {
  const VoxelSolid solid = voxelize(mesh, grid_for(mesh, resolution, 1), InsideRule::kWinding);
  std::size_t index = 0;
  std::size_t wrong = 0;
  each_centre(solid.grid, [&](const Eigen::Vector3d& centre) {
    const double winding = winding_number(mesh, centre);
    const bool says_inside = solid.labels[index++] == VoxelLabel::kInside;
    wrong += std::abs(winding - 0.5) > 1e-9 && says_inside != (winding > 0.5);
    return false;
  });
  EXPECT_EQ(wrong, 0u) << what;
}

TEST(VoxelizeTest, OpenMeshesFollowTheWindingNumber) {
  Mesh bowl = make_sphere(1.0, 8);
  bowl.triangles.resize(bowl.triangles.size() * 2 / 3);
  expect_winding(bowl, 21, "a third is missing");
  Mesh holes = make_rough_solid(1.0, 8, 3);
  for (const std::size_t t : {1200u, 700u, 701u, 300u, 5u}) {
    holes.triangles.erase(holes.triangles.begin() + static_cast<std::ptrdiff_t>(t));
  }
  expect_winding(holes, 24, "several holes");
  Mesh one_turned = make_torus(1.0, 0.4, 12, 10);
  std::swap(one_turned.triangles[7][0], one_turned.triangles[7][1]);
  expect_winding(one_turned, 20, "a boundary that counts twice");
  expect_winding(make_gear(), 20, "closed");
}

/// Every triangle with vertices of its own, drawn towards its middle by a share.
Mesh apart(const Mesh& mesh, double share) {
  Mesh result;
  for (const Triangle& t : mesh.triangles) {
    const auto first = static_cast<std::int32_t>(result.vertices.size());
    const Eigen::Vector3d middle =
        (mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]) / 3.0;
    for (const std::int32_t corner : t) {
      result.vertices.push_back(mesh.vertices[corner] + share * (middle - mesh.vertices[corner]));
    }
    result.triangles.push_back({first, first + 1, first + 2});
  }
  return result;
}

TEST(VoxelizeTest, TrianglesThatShareNothingFollowTheWindingNumberToo) {
  const Mesh gaps = apart(make_sphere(1.0, 9), 0.1);
  EXPECT_EQ(fitting_rule(gaps), InsideRule::kWinding);
  expect_winding(gaps, 12, "1,620 cones");
  expect_winding(apart(make_sphere(1.0, 9), 0.0), 12, "equal places");
}

Mesh looking_inwards(Mesh mesh) {
  for (Triangle& triangle : mesh.triangles) {
    std::swap(triangle[0], triangle[1]);
  }
  return mesh;
}

TEST(VoxelizeTest, AnOpenMeshHasTheSameInsideWhicheverWayItsFacesLook) {
  Mesh hole = make_sphere(1.0, 8);
  hole.triangles.pop_back();
  const Mesh sphere = make_sphere(1.0, 9);
  for (const Mesh& mesh :
       {hole, apart(sphere, 0.0), apart(sphere, 0.1), apart(make_sphere(1.0, 32), 0.1)}) {
    const VoxelGrid grid = grid_for(mesh, 5, 1);
    const VoxelSolid outwards = voxelize(mesh, grid, InsideRule::kWinding);
    EXPECT_GT(count_inside(outwards), 50u);
    EXPECT_EQ(inside(voxelize(looking_inwards(mesh), grid, InsideRule::kWinding)),
              inside(outwards));
  }
}

TEST(VoxelizeTest, AMeshThatIsMostlyBoundaryIsLeftToTheHierarchy) {
  expect_winding(apart(make_sphere(1.0, 32), 0.1), 5, "20,480 cones");
}

TEST(VoxelizeTest, ASoupOfManyTrianglesIsClosedByItsPlaces) {
  const Mesh whole = make_rough_solid(1.0, 40, 4);  // 32,000 triangles
  const VoxelGrid grid = grid_for(whole, 40);
  EXPECT_EQ(inside(voxelize(apart(whole, 0.0), grid, InsideRule::kWinding)),
            inside(voxelize(whole, grid, InsideRule::kParity)));
}

double volume_within(const Mesh& mesh, int resolution) {
  const VoxelSolid solid = voxelize(mesh, grid_for(mesh, resolution), fitting_rule(mesh));
  return static_cast<double>(count_inside(solid)) * std::pow(solid.grid.spacing, 3);
}

TEST(VoxelizeTest, OverlappingClosedPartsAreTheirUnion) {
  Mesh cubes = with_moved(cube(), {1.0, 0.6, 0.4});
  const double both = 16.0 - 1.0 * 1.4 * 1.6;  // twice a cube of side 2, once what they share
  EXPECT_NEAR(volume_within(cubes, 150), both, 1e-9);
  for (Triangle& triangle : cubes.triangles) {
    std::swap(triangle[0], triangle[1]);
  }
  EXPECT_NEAR(volume_within(cubes, 150), both, 1e-9) << "all faces look inwards";
}

TEST(VoxelizeTest, ACavityIsAShellThatLooksInwards) {
  Mesh hollow = cube();
  for (const Mesh inner = cube(); const Eigen::Vector3d& vertex : inner.vertices) {
    hollow.vertices.push_back(0.5 * vertex);
  }
  for (const Triangle& t : cube().triangles) {
    hollow.triangles.push_back({t[1] + 8, t[0] + 8, t[2] + 8});
  }
  EXPECT_NEAR(volume_within(hollow, 40), 7.0, 1e-9);
}

TEST(VoxelizeTest, AClosedMeshWhoseFacesDisagreeIsFilledByParity) {
  Mesh mesh = cube();
  std::swap(mesh.triangles[4][0], mesh.triangles[4][1]);
  EXPECT_EQ(fitting_rule(mesh), InsideRule::kParity);
  EXPECT_NEAR(volume_within(mesh, 20), 8.0, 1e-9);
}

TEST(VoxelizeTest, TwiceTheSurfaceIsOutsideByParityAndInsideByWinding) {
  Mesh mesh = make_sphere(1.0, 5);
  const auto once = mesh.triangles;
  mesh.triangles.insert(mesh.triangles.end(), once.begin(), once.end());
  EXPECT_EQ(fitting_rule(mesh), InsideRule::kWinding);
  EXPECT_EQ(count_inside(voxelize(mesh, grid_for(mesh, 9), InsideRule::kParity)), 0u);
  EXPECT_GT(count_inside(voxelize(mesh, grid_for(mesh, 9), InsideRule::kWinding)), 100u);
}

TEST(VoxelizeTest, TheBorderIsTheLayerAroundTheSolid) {
  const Mesh mesh = make_rough_solid(1.0, 20, 9);
  VoxelSolid solid = voxelize(mesh, grid_for(mesh, 40, 2), InsideRule::kParity);
  const auto check = [&] {
    const VoxelGrid& g = solid.grid;
    for (std::int32_t k = 1; k + 1 < g.size[2]; ++k) {
      for (std::int32_t j = 1; j + 1 < g.size[1]; ++j) {
        for (std::int32_t i = 1; i + 1 < g.size[0]; ++i) {
          const auto is = [&](int x, int y, int z) {
            return solid.labels[g.index(i + x, j + y, k + z)] == VoxelLabel::kInside;
          };
          const bool touches = is(1, 0, 0) || is(-1, 0, 0) || is(0, 1, 0) || is(0, -1, 0) ||
                               is(0, 0, 1) || is(0, 0, -1);
          ASSERT_EQ(solid.labels[g.index(i, j, k)] == VoxelLabel::kBorder, !is(0, 0, 0) && touches);
        }
      }
    }
  };
  check();
  const std::size_t before = count_inside(solid);
  const auto layer = static_cast<std::size_t>(
      std::count(solid.labels.begin(), solid.labels.end(), VoxelLabel::kBorder));
  grow(solid);
  check();
  EXPECT_EQ(count_inside(solid), before + layer);
}

TEST(VoxelizeTest, ParityAndFloodRefuseOpenMeshes) {
  Mesh mesh = make_sphere(1.0, 4);
  mesh.triangles.pop_back();
  EXPECT_THROW(voxelize(mesh, grid_for(mesh, 5), InsideRule::kParity), InputError);
  EXPECT_THROW(voxelize(mesh, grid_for(mesh, 5), InsideRule::kFlood), InputError);
  EXPECT_THROW(voxelize(make_torus(1.0, 0.01, 8, 8), grid_for(make_torus(1.0, 0.01, 8, 8), 2),
                        InsideRule::kFlood),
               InputError)
      << "no centre inside";
}

TEST(VoxelizeTest, LongWorkMayBeCancelled) {
  const Mesh mesh = make_sphere(1.0, 40);
  EXPECT_THROW(
      voxelize(mesh, grid_for(mesh, 20), InsideRule::kParity, [](double) { return false; }),
      Cancelled);
}

TEST(VoxelizeTest, TheMemoryThatIsForeseenBoundsTheCrossings) {
  for (const Mesh& mesh : {make_gear(), make_rough_solid(1.0, 20, 1)}) {
    const VoxelGrid grid = grid_for(mesh, 50);
    const GridCrossings crossings(mesh, grid, 0);
    EXPECT_LE(static_cast<double>(3 * sizeof(Crossing) * crossings.count()),
              crossing_memory(mesh, grid));
    EXPECT_GE(voxelizing_memory(mesh, grid, InsideRule::kFlood),
              voxelizing_memory(mesh, grid, InsideRule::kParity));
  }
}

TEST(BoundaryConeTest, ClosesWhateverItIsGiven) {
  RandomStream random(4, "cones");
  for (int round = 0; round < 50; ++round) {
    Mesh mesh;
    for (int v = 0; v < 12; ++v) {
      mesh.vertices.push_back({random.uniform(), random.uniform(), random.uniform()});
    }
    for (int t = 0; t < 15; ++t) {
      mesh.triangles.push_back({static_cast<std::int32_t>(random.below(12)),
                                static_cast<std::int32_t>(random.below(12)),
                                static_cast<std::int32_t>(random.below(12))});
    }
    const BoundaryCone cone = boundary_cone(mesh);
    const Eigen::Vector3d point(random.uniform(), random.uniform(), random.uniform());
    const double both = winding_sum(mesh, point) + winding_sum(cone.mesh, point);
    EXPECT_NEAR(both, std::round(both), 1e-9) << "a closed mesh winds a whole number of times";
  }
  EXPECT_TRUE(boundary_cone(make_gear()).mesh.triangles.empty());
}

TEST(BoundaryConeTest, SumsOfManyPointsAreThoseOfOneOnEveryInstructionSet) {
  Mesh mesh = make_sphere(2.0, 6);
  mesh.triangles.resize(500);
  RandomStream random(5, "sums");
  PointLanes points{};
  for (std::size_t l = 0; l < kPointLanes; ++l) {
    points.x[l] = static_cast<float>(random.uniform(-2, 2));
    points.y[l] = static_cast<float>(random.uniform(-2, 2));
    points.z[l] = static_cast<float>(random.uniform(-2, 2));
  }
  std::vector<Eigen::Vector3f> corners;
  for (const Triangle& t : mesh.triangles) {
    for (const std::int32_t corner : t) {
      corners.push_back(mesh.vertices[corner].cast<float>());
    }
  }
  std::array<float, kPointLanes> baseline{};
  winding_sums(corners, points, baseline, InstructionSet::kBaseline);
  for (std::size_t l = 0; l < kPointLanes; ++l) {
    EXPECT_NEAR(baseline[l], winding_sum(mesh, {points.x[l], points.y[l], points.z[l]}), 2e-5);
  }
  for (const InstructionSet set : available_instruction_sets()) {
    std::array<float, kPointLanes> sums{};
    winding_sums(corners, points, sums, set);
    EXPECT_EQ(sums, baseline) << name_of(set);
  }
}

TEST(VoxelizeTest, TheStanfordBunnyVoxelizesLikeItsClosedSister) {
  const auto open = test::shared_data("meshes/stanford-bunny.obj");
  const auto closed = test::shared_data("meshes/bunny_watertight_29k_fcpw.obj");
  if (!open || !closed) {
    GTEST_SKIP() << "neither HAPTRIAL_DATA nor ../shared/data holds meshes/stanford-bunny.obj and "
                    "its sister";
  }
  const auto voxels = [](const Mesh& mesh) {
    return static_cast<double>(
        count_inside(voxelize(mesh, grid_for(mesh, 60), fitting_rule(mesh))));
  };
  const Mesh bunny = read_mesh(*open);
  EXPECT_EQ(fitting_rule(bunny), InsideRule::kWinding);
  EXPECT_NEAR(voxels(bunny) / voxels(read_mesh(*closed)), 1.0, 0.002);
}

}  // namespace
}  // namespace haptrial::geometry
