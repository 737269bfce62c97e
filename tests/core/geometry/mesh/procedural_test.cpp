#include "core/geometry/mesh/procedural.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "core/geometry/mesh/mesh_size.h"
#include "core/geometry/volume/mesh_check.h"

namespace haptrial::geometry {
namespace {

constexpr double kPi = std::numbers::pi;

void expect_sound(const Mesh& mesh, std::size_t genus) {
  const MeshReport report = check_mesh(mesh);
  EXPECT_TRUE(report.closed);
  EXPECT_TRUE(report.manifold());
  EXPECT_TRUE(report.oriented());
  EXPECT_EQ(report.components, 1u);
  EXPECT_EQ(report.genus, genus);
  EXPECT_GT(report.volume, 0.0) << "faces look outwards";
  EXPECT_EQ(report.unreferenced_vertices + report.flat_triangles + report.duplicate_triangles, 0u);
}

TEST(ProceduralTest, ASphereHasItsVolumeAndAreaInTheLimit) {
  double error = 1.0;
  for (const int frequency : {4, 8, 16}) {
    const Mesh mesh = make_sphere(0.3, frequency);
    EXPECT_EQ(mesh.triangles.size(), 20u * frequency * frequency);
    expect_sound(mesh, 0);
    const double now = 1.0 - signed_volume(mesh) / (4.0 / 3.0 * kPi * 0.027);
    EXPECT_GT(now, 0.0) << "inscribed";
    EXPECT_LT(now, 0.3 * error) << "falls with the square of the frequency";
    error = now;
  }
  EXPECT_NEAR(check_mesh(make_sphere(2.0, 40)).area, 16.0 * kPi, 0.02);
}

TEST(ProceduralTest, ATorusHasOneHandleAndItsVolume) {
  const Mesh mesh = make_torus(1.0, 0.25, 200, 100);
  EXPECT_EQ(mesh.triangles.size(), 40000u);
  expect_sound(mesh, 1);
  EXPECT_NEAR(signed_volume(mesh), 2.0 * kPi * kPi * 0.0625, 2e-3);
}

TEST(ProceduralTest, AGearIsAnExtrudedRingOfTeeth) {
  const GearShape shape;
  const Mesh mesh = make_gear(shape);
  EXPECT_EQ(mesh.triangles.size(), 992u) << "about 1,000, as the source's";
  expect_sound(mesh, 1);
  // Four triangles from the axis a tooth: root to root, up, tip to tip, down. The bore's corners
  // stand at the same angles.
  const double pitch = 2.0 * kPi / shape.teeth;
  const double root = shape.root_radius;
  const double tip = shape.tip_radius;
  const double bore = shape.bore_radius;
  const auto ring = [&](double a, double b, double part) {
    return 0.5 * (a * b - bore * bore) * std::sin(part * pitch);
  };
  const double tooth =
      ring(root, root, 0.35) + ring(root, tip, 0.15) + ring(tip, tip, 0.35) + ring(tip, root, 0.15);
  EXPECT_NEAR(signed_volume(mesh), tooth * shape.teeth * shape.thickness, 1e-15);
}

TEST(ProceduralTest, ARoughSolidIsSeededAndSeenWholeFromItsMiddle) {
  const Mesh mesh = make_rough_solid(0.2, 100, 7);
  EXPECT_EQ(mesh.triangles.size(), 200000u);
  expect_sound(mesh, 0);
  for (const Triangle& t : mesh.triangles) {
    const Eigen::Vector3d& a = mesh.vertices[t[0]];
    ASSERT_GT(a.dot(mesh.vertices[t[1]].cross(mesh.vertices[t[2]])), 0.0);
  }
  const Mesh small = make_rough_solid(0.2, 5, 7);
  EXPECT_EQ(make_rough_solid(0.2, 5, 7).vertices, small.vertices);
  EXPECT_NE(make_rough_solid(0.2, 5, 8).vertices, small.vertices);
  const double convex = check_mesh(make_sphere(0.1, 100)).area;
  EXPECT_GT(check_mesh(mesh).area / std::pow(signed_volume(mesh), 2.0 / 3.0),
            1.1 * convex / std::pow(signed_volume(make_sphere(0.1, 100)), 2.0 / 3.0))
      << "rough";
}

TEST(ProceduralTest, BadShapesAreRefused) {
  EXPECT_THROW(make_sphere(0.0, 4), std::invalid_argument);
  EXPECT_THROW(make_sphere(std::nan(""), 4), std::invalid_argument);
  EXPECT_THROW(make_sphere(1.0, 0), std::invalid_argument);
  EXPECT_THROW(make_torus(1.0, 1.0, 10, 10), std::invalid_argument);
  EXPECT_THROW(make_torus(1.0, 0.5, 2, 10), std::invalid_argument);
  EXPECT_THROW(make_gear({.teeth = 2}), std::invalid_argument);
  EXPECT_THROW(make_gear({.bore_radius = 0.045}), std::invalid_argument);
  EXPECT_THROW(make_rough_solid(-1.0, 5, 1), std::invalid_argument);
}

}  // namespace
}  // namespace haptrial::geometry
