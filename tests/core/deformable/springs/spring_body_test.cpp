#include "core/deformable/springs/spring_body.h"

#include <gtest/gtest.h>

#include <numeric>

#include "tests/support/message_of.h"
#include "tests/support/solid_block.h"

namespace haptrial::deformable {
namespace {

using Eigen::Vector3d;

TEST(SpringBodyTest, MassesSumToThatOfTheBlock) {
  const SpringBody body = spring_body(test::solid_block({3, 4, 2}, 0.01), 980, {1, 1, 1});
  const double mass = std::accumulate(body.masses.begin(), body.masses.end(), 0.0);
  EXPECT_NEAR(mass, 980 * 24e-6, 1e-16);
}

// A block whose lower half is twice as heavy: its centre of mass lies at 5/12 of its height.
TEST(SpringBodyTest, EachMaterialHasItsOwnMass) {
  const geometry::TetMesh mesh = test::solid_block({2, 2, 4}, 0.01);
  std::vector<double> densities;
  for (const geometry::Tetrahedron& t : mesh.tetrahedra) {
    double z = 0.0;
    for (const std::int32_t v : t) {
      z += 0.25 * mesh.vertices[static_cast<std::size_t>(v)].z();
    }
    densities.push_back(z < 0.02 ? 2000.0 : 1000.0);
  }
  const SpringBody body = spring_body(mesh, densities, {1, 1, 1});
  double mass = 0.0, moment = 0.0;
  for (std::size_t v = 0; v < body.masses.size(); ++v) {
    mass += body.masses[v];
    moment += body.masses[v] * body.rest[v].z();
  }
  EXPECT_NEAR(mass, 1500.0 * 16e-6, 1e-15);
  EXPECT_NEAR(moment / mass, 0.04 * 5.0 / 12.0, 1e-12);
}

TEST(SpringBodyTest, OneDensityForEachTetrahedron) {
  const geometry::TetMesh mesh = test::solid_block({1, 1, 1}, 0.01);
  EXPECT_EQ(test::message_of([&] {
              spring_body(mesh, std::vector<double>{1000.0, 1.0}, {1, 1, 1}, "liver");
            }),
            "liver: 2 densities are given for 5 tetrahedra");
}

// Every edge, face and tetrahedron stretched alike: the energy is that of the strains alone.
TEST(SpringBodyTest, TheEnergyOfAUniformStretchIsThatOfItsStrains) {
  const SpringBody body = spring_body(test::solid_block({2, 2, 2}, 0.01), 1000, {0.3, 0.2, 0.1});
  std::vector<Vector3d> positions = body.rest;
  for (Vector3d& p : positions) {
    p *= 1.1;
  }
  const double length = 0.1;
  const double area = 1.1 * 1.1 - 1;
  const double volume = 1.1 * 1.1 * 1.1 - 1;
  const double expected = 0.5 * 0.3 * length * length * static_cast<double>(body.lengths.size()) +
                          0.5 * 0.2 * area * area * static_cast<double>(body.areas.size()) +
                          0.5 * 0.1 * volume * volume * static_cast<double>(body.volumes.size());
  EXPECT_NEAR(spring_energy(body, positions), expected, 1e-12 * expected);
}

TEST(SpringBodyTest, BadInputIsRefused) {
  geometry::TetMesh mesh = test::solid_block({1, 1, 1}, 0.01);
  EXPECT_EQ(test::message_of([&] {
              spring_body(mesh, 0, {1, 1, 1}, "liver");
            }),
            "liver: the density is 0 kg/m³; above 0 is allowed");
  EXPECT_EQ(test::message_of([&] {
              spring_body(mesh, 1000, {1, -2, 1});
            }),
            "springs: constant 0 of faces is -2 J; at least 0 is allowed");
  std::swap(mesh.tetrahedra[2][0], mesh.tetrahedra[2][1]);
  EXPECT_NE(test::message_of([&] {
              spring_body(mesh, 1000, {1, 1, 1}, "liver");
            }).find("liver: tetrahedron 2 (vertices"),
            std::string::npos);
}

TEST(SpringBodyTest, ConstantsOfAnotherBodyAreRefused) {
  const SpringBody body = spring_body(test::solid_block({1, 1, 1}, 0.01), 1000, {1, 1, 1});
  SpringConstants constants = body.constants;
  constants.volume.pop_back();
  EXPECT_EQ(test::message_of([&] { check_constants(body, constants); }),
            "springs: 4 constants of tetrahedra are given for 5");
}

}  // namespace
}  // namespace haptrial::deformable
