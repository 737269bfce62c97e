#include "core/bone/simulator/plate.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "core/base/definition/schema.h"
#include "core/base/error.h"
#include "core/bone/simulator/plate_shapes.h"
#include "core/geometry/files/mesh_io.h"
#include "core/geometry/mesh/mesh_size.h"
#include "core/geometry/volume/mesh_check.h"
#include "tests/core/bone/model/pieces_support.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::bone::plate_test {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using test::make_box;

constexpr double kEdge = 0.5e-3;  // of a voxel of make_box [m]

double area_of(const geometry::Mesh& mesh) {
  double sum = 0.0;
  for (const geometry::Triangle& t : mesh.triangles) {
    const auto at = [&](std::size_t i) { return mesh.vertices[static_cast<std::size_t>(t[i])]; };
    sum += 0.5 * (at(1) - at(0)).cross(at(2) - at(0)).norm();
  }
  return sum;
}

/// Area that a plate covers, by asking at many points.
double footprint(const PlateShape& shape) {
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector2d& hole : shape.holes) {
    box.extend(hole - Eigen::Vector2d::Constant(shape.pad_radius));
    box.extend(hole + Eigen::Vector2d::Constant(shape.pad_radius));
  }
  const auto covered = [&](const Eigen::Vector2d& p) {
    bool inside = false;
    for (std::size_t i = 0; i < shape.holes.size(); ++i) {
      const double distance = (p - shape.holes[i]).norm();
      if (distance < shape.hole_radius) {
        return false;
      }
      inside = inside || distance < shape.pad_radius;
      if (i > 0) {
        const Eigen::Vector2d way = shape.holes[i] - shape.holes[i - 1];
        const Eigen::Vector2d from = p - shape.holes[i - 1];
        const double along = from.dot(way.normalized());
        const double beside = std::sqrt(std::max(0.0, from.squaredNorm() - along * along));
        inside = inside || (along > 0.0 && along < way.norm() && beside < 0.5 * shape.bar_width);
      }
    }
    return inside;
  };
  constexpr double kStep = 2e-5;
  std::int64_t hits = 0;
  for (double y = box.min().y(); y < box.max().y(); y += kStep) {
    for (double x = box.min().x(); x < box.max().x(); x += kStep) {
      hits += covered({x, y}) ? 1 : 0;
    }
  }
  return static_cast<double>(hits) * kStep * kStep;
}

TEST(PlateShapesTest, PlatesAreClosedWithAHoleForEveryScrew) {
  for (const PlateShape& shape : {straight_miniplate(4), straight_miniplate(6), l_plate(4, 2),
                                  l_plate(1, 0), straight_miniplate(2)}) {
    const geometry::Mesh mesh = make_plate(shape);
    const geometry::MeshReport report = geometry::check_mesh(mesh);
    EXPECT_TRUE(report.closed);
    EXPECT_TRUE(report.manifold());
    EXPECT_TRUE(report.oriented());
    EXPECT_EQ(report.flat_triangles, 0U);
    EXPECT_EQ(report.components, 1U);
    EXPECT_EQ(report.genus, shape.holes.size());
    // Polygons in circles are smaller by 1 %; where parts overlapped, they would count twice.
    const double volume = geometry::signed_volume(mesh);
    EXPECT_NEAR(volume, footprint(shape) * shape.thickness, 0.03 * volume);
    const Vector3d box = geometry::bounds(mesh).sizes();
    EXPECT_DOUBLE_EQ(box.z(), 1e-3);
  }
}

TEST(PlateShapesTest, SizesThatDoNotFitAreRefused) {
  EXPECT_THROW(make_plate({}), std::invalid_argument);
  EXPECT_THROW(make_plate({.holes = {{0, 0}, {4e-3, 0}}}), std::invalid_argument);
  EXPECT_THROW(make_plate({.holes = {{0, 0}}, .hole_radius = 3e-3}), std::invalid_argument);
  EXPECT_THROW(make_plate({.holes = {{6e-3, 0}, {0, 0}, {6e-3, 5.1e-3}}}), std::invalid_argument);
  EXPECT_THROW(make_plate({.holes = {{0, 0}}, .thickness = std::nan("")}), std::invalid_argument);
  EXPECT_THROW(straight_miniplate(1), std::invalid_argument);
  EXPECT_THROW(make_distractor(0.0), std::invalid_argument);
}

TEST(PlateShapesTest, ADistractorIsThreeClosedBodies) {
  const geometry::Mesh mesh = make_distractor(5e-3);
  const geometry::MeshReport report = geometry::check_mesh(mesh);
  EXPECT_EQ(report.boundary_edges, 0U);
  EXPECT_EQ(report.components, 3U);
  EXPECT_GT(geometry::signed_volume(mesh), 0.0);
}

TEST(PlateModelTest, SamplesLieEvenlyOverTheSurfacePushedOut) {
  const PlateModel plate("plate", make_plate(straight_miniplate(6)));
  ASSERT_EQ(plate.samples().size(), 100U);
  const double even = std::sqrt(area_of(plate.mesh()) / 100.0);
  int down = 0;
  for (std::size_t i = 0; i < 100; ++i) {
    const PlateSample& a = plate.samples()[i];
    EXPECT_NEAR(a.normal.norm(), 1.0, 1e-12);
    EXPECT_NEAR((plate.samples()[i].point - 0.25e-3 * a.normal -
                 *std::min_element(plate.mesh().vertices.begin(), plate.mesh().vertices.end(),
                                   [&](const Vector3d& p, const Vector3d& q) {
                                     const Vector3d on = a.point - 0.25e-3 * a.normal;
                                     return (p - on).norm() < (q - on).norm();
                                   }))
                    .norm(),
                0.0, 1e-12);
    down += a.normal.z() < -0.99 ? 1 : 0;
    for (std::size_t j = 0; j < i; ++j) {
      const PlateSample& b = plate.samples()[j];
      EXPECT_GT((a.point - b.point).norm() + even * (a.normal - b.normal).norm(), 0.4 * even);
    }
  }
  // No vertex is far from a sample on either side.
  for (const Vector3d& vertex : plate.mesh().vertices) {
    double nearest = 1.0;
    for (const PlateSample& sample : plate.samples()) {
      nearest = std::min(nearest, (sample.point - vertex).norm());
    }
    EXPECT_LT(nearest, 1.5 * even);
  }
  EXPECT_GT(down, 15);
}

/// A thick slab whose upper side is z = 0 of the slab's own frame.
class SlabTest : public testing::Test {
 protected:
  SlabTest() : world_(make_box({80, 60, 40}), Isometry3d(Eigen::Translation3d(-top()))) {}

  static Vector3d top() {
    const geometry::VoxelGrid grid = make_box({80, 60, 40}).grid;
    return grid.centre(40, 30, 39) + Vector3d(0, 0, 0.5 * kEdge);
  }
  Isometry3d lying(double depth, double turn = 0.3) const {
    Isometry3d pose(Eigen::AngleAxisd(turn, Vector3d::UnitZ()));
    pose.translation().z() = 0.25e-3 - depth;  // the samples stick out by so much
    return pose;
  }

  BoneWorld world_;
  PlateModel plate_{"plate", make_plate(straight_miniplate(6))};
};

TEST_F(SlabTest, WithoutContactThereIsNoForce) {
  const PlateContact contact = press(plate_, lying(-1e-6), world_);
  EXPECT_EQ(contact.touching, 0);
  EXPECT_EQ(contact.force.norm(), 0.0);
  EXPECT_EQ(contact.pieces, 0U);
  EXPECT_EQ(attach(plate_, 0, lying(-1e-6), world_), -1);
  Isometry3d nowhere = Isometry3d::Identity();
  nowhere.translation().x() = std::nan("");
  EXPECT_EQ(press(plate_, nowhere, world_).force.norm(), 0.0);
}

TEST_F(SlabTest, OnAFlatTheForceIsAlongTheNormalAndGrowsWithDepthAsASpringPerSample) {
  int below = 0;
  for (const PlateSample& sample : plate_.samples()) {
    below += sample.normal.z() < -0.99 ? 1 : 0;
  }
  // Until the walls' samples come in at 0.25 mm, the lower side's alone are in the bone.
  for (const double depth : {0.01e-3, 0.05e-3, 0.1e-3, 0.15e-3, 0.2e-3, 0.24e-3}) {
    for (const double turn : {0.0, 0.3, -0.5}) {
      const PlateContact contact = press(plate_, lying(depth, turn), world_);
      EXPECT_EQ(contact.touching, below);
      EXPECT_NEAR(contact.force.z(), 40.0 * below * depth, 1e-9);
      EXPECT_NEAR(contact.force.head<2>().norm(), 0.0, 1e-9);
    }
  }
  double before = 0.0;
  for (double depth = 0.0; depth < 0.9e-3; depth += 0.02e-3) {
    const double force = press(plate_, lying(depth), world_).force.z();
    EXPECT_GE(force, before);
    before = force;
  }
}

TEST_F(SlabTest, TheForceTurnsWithTheWorldAndThePlateIsRightedByItsTorque) {
  Isometry3d tilt(Eigen::AngleAxisd(0.05, Vector3d::UnitY()));  // the end at -x is pressed less
  tilt.translation().z() = 0.25e-3;
  const PlateContact contact = press(plate_, tilt, world_);
  EXPECT_GT(contact.touching, 0);
  EXPECT_GT(contact.force.z(), 0.0);
  EXPECT_LT(contact.torque.y(), 0.0);

  RandomStream random(4, "poses");
  const Vector3d axis(random.normal(), random.normal(), random.normal());
  Isometry3d turned(Eigen::AngleAxisd(1.1, axis.normalized()));
  turned.translation() = Vector3d(0.1, 0.2, -0.3);
  BoneWorld elsewhere(make_box({80, 60, 40}), turned * world_.pose(0));
  const PlateContact there = press(plate_, turned * tilt, elsewhere);
  EXPECT_EQ(there.touching, contact.touching);
  EXPECT_TRUE(there.force.isApprox(turned.linear() * contact.force, 1e-6));
  EXPECT_TRUE(there.torque.isApprox(turned.linear() * contact.torque, 1e-6));
}

TEST_F(SlabTest, APlateOverACutJoinsBothPiecesAndIsTakenOffAgain) {
  const geometry::VoxelGrid grid = world_.volume(0).grid();
  test::for_each_voxel(grid, [&](const Voxel& v) {
    if (v.x() == 44) {
      world_.volume(0).take(world_.volume(0).address(v), 1.0F);
    }
  });
  test::settle(world_);
  ASSERT_EQ(world_.pieces(), 2);
  EXPECT_EQ(world_.joined_with(0), 1U);
  std::size_t allocations = 0;
  int number = -1;
  {
    haptrial::test::AllocationGuard guard;
    EXPECT_EQ(press(plate_, lying(0.1e-3), world_).pieces, 3U);
    number = attach(plate_, 7, lying(0.1e-3), world_);
    allocations = guard.count();
  }
  EXPECT_EQ(allocations, 0U);
  ASSERT_EQ(number, 0);
  EXPECT_EQ(world_.plate_model(0), 7);
  EXPECT_EQ(world_.joined_with(0), 3U);
  EXPECT_EQ(world_.joined_with(1), 3U);
  // Whatever is pulled, everything goes along as one.
  const Isometry3d apart = world_.pose(0).inverse() * world_.pose(1);
  const Isometry3d on = world_.pose(1).inverse() * world_.plate_pose(0);
  for (const Voxel& pulled : {Voxel(10, 30, 39), Voxel(70, 30, 39)}) {
    world_.grab({world_.holder(pulled), pulled, 0.0}, Isometry3d::Identity());
    Isometry3d tool(Eigen::AngleAxisd(0.4, Vector3d::UnitX()));
    tool.translation() = Vector3d(0.01, 0.02, 0.0);
    world_.drag(tool);
    world_.release();
    EXPECT_TRUE((world_.pose(0).inverse() * world_.pose(1)).isApprox(apart, 1e-12));
    EXPECT_TRUE((world_.pose(1).inverse() * world_.plate_pose(0)).isApprox(on, 1e-12));
  }
  Isometry3d published;
  world_.published_plates().read(1, [&](int, const Isometry3d& pose) { published = pose; });
  EXPECT_TRUE(published.isApprox(world_.plate_pose(0), 0.0));
  world_.detach_plate(number);
  EXPECT_FALSE(world_.plate_is_on(number));
  EXPECT_EQ(world_.joined_with(0), 1U);
}

TEST_F(SlabTest, APlateThatLayOverTheCutBeforeStillJoinsThePieces) {
  ASSERT_EQ(attach(plate_, 0, lying(0.1e-3), world_), 0);
  const geometry::VoxelGrid grid = world_.volume(0).grid();
  test::for_each_voxel(grid, [&](const Voxel& v) {
    if (v.x() == 44) {
      world_.volume(0).take(world_.volume(0).address(v), 1.0F);
    }
  });
  test::settle(world_);
  ASSERT_EQ(world_.pieces(), 2);
  EXPECT_EQ(world_.joined_with(1), 3U);
}

TEST(PlateModelTest, LoadsMeshesOfOtherMakers) {
  const haptrial::test::TemporaryFolder folder;
  geometry::Mesh mesh = make_plate(l_plate());
  for (Vector3d& vertex : mesh.vertices) {
    vertex *= 1e3;  // files are in millimetres
  }
  for (const char* name : {"plate.stl", "plate.obj"}) {
    const std::filesystem::path file = folder.path() / name;
    geometry::write_mesh(file, mesh);
    const PlateModel plate = PlateModel::load(file);
    EXPECT_EQ(plate.name(), "plate");
    EXPECT_EQ(plate.samples().size(), 100U);
    EXPECT_NEAR(area_of(plate.mesh()), area_of(make_plate(l_plate())), 1e-10);
  }
  const std::filesystem::path flat = folder.path() / "flat.obj";
  std::ofstream(flat) << "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n";
  EXPECT_THROW(PlateModel::load(flat), InputError);
  EXPECT_THROW(PlateModel::load(folder.path() / "none.obj"), InputError);
  EXPECT_THROW(PlateModel("bad", make_plate(l_plate()), {.samples = 101}), std::invalid_argument);
}

TEST(PlateModelTest, ParametersAreReadFromADefinition) {
  Table good =
      Table::parse("samples = 50\nextrusion = 0.0002\nreach = 0.004\nstiffness = 80.0\n", "p.toml");
  const PlateParameters read = plate_schema().read(good);
  good.finish();
  EXPECT_EQ(read.samples, 50);
  EXPECT_EQ(read.extrusion, 0.0002);
  EXPECT_EQ(read.reach, 0.004);
  EXPECT_EQ(read.stiffness, 80.0);
  Table bad = Table::parse("samples = 101\nextrusion = 0\nreach = 1\nstiffness = 1\n", "p.toml");
  plate_schema().read(bad);
  EXPECT_THROW(bad.finish(), InputError);
}

TEST(PlateModelTest, ACoarseMeshIsFeltAllOver) {
  // A tetrahedron has twelve sides of vertices, too few to feel with.
  geometry::Mesh mesh;
  mesh.vertices = {{0, 0, 0}, {0.01, 0, 0}, {0, 0.01, 0}, {0, 0, 0.01}};
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  const PlateModel plate("tetrahedron", mesh);
  EXPECT_EQ(plate.samples().size(), 100U);
}

}  // namespace
}  // namespace haptrial::bone::plate_test
