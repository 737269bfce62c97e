#include "core/base/definition/angular_units.h"

#include <gtest/gtest.h>

#include "core/base/definition/table.h"
#include "core/base/definition/table_vector.h"
#include "core/base/error.h"
#include "tests/support/message_of.h"

namespace haptrial {
namespace {

constexpr double kRadius = 0.02;  // [m]

/// A table [knob] that states its numbers of a rotation.
struct Knob {
  explicit Knob(const std::string& keys) : document(Table::parse("[knob]\n" + keys, "k.toml")) {
    document.table("knob").state_in(AngularUnits(kRadius));
  }
  Table table() { return document.table("knob"); }
  Table document;
};

// A spring of k N·m/rad turned by phi gives k phi; along the arc r phi it gives that over r.
TEST(AngularUnitsTest, ASpringGivesTheSameTorqueWhicheverUnitsStateIt) {
  Knob knob("angle = 0.7\nstiffness = 0.3\ndamping = 0.002\n");
  const double arc = knob.table().number("angle", {-0.5, 0.5}, "m");
  const double stiffness = knob.table().number("stiffness", {0.0, 1e5}, "N/m");
  const double damping = knob.table().number("damping", {0.0, 1e4}, "N·s/m");
  EXPECT_NEAR(kRadius * stiffness * arc, 0.3 * 0.7, 1e-15);
  EXPECT_NEAR(kRadius * damping * (kRadius * 5.0), 0.002 * 5.0, 1e-15);
  knob.document.finish();
}

TEST(AngularUnitsTest, VectorsListsAndMatricesAreTakenToo) {
  Knob knob(
      "at = [0.1, 0.0, -0.2]\ntorques = [0.1, 0.2]\nmatrix = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]\n"
      "places = [[1, 0, 0]]\n");
  Table table = knob.table();
  EXPECT_TRUE(read_vector(table, "at", {-1.0, 1.0}, "m", {})
                  .isApprox(kRadius * Eigen::Vector3d(0.1, 0.0, -0.2), 1e-14));
  EXPECT_NEAR(table.numbers("torques", {0.0, 100.0}, "N")[1], 0.2 / kRadius, 1e-12);
  EXPECT_NEAR(read_matrix(table, "matrix", {0.0, 1e4}, "N·s/m").trace(), 3.0 / (kRadius * kRadius),
              1e-9);
  EXPECT_NEAR(read_vectors(table, "places", {-1.0, 1.0}, "m")[0].x(), kRadius, 1e-15);
  knob.document.finish();
}

TEST(AngularUnitsTest, WhatHasNoLengthInItStaysAsItIs) {
  Knob knob("time = 0.5\nfrequency = 50.0\ndirection = [0.0, 1.0, 0.0]\n");
  Table table = knob.table();
  EXPECT_EQ(table.number("time", kPositive, "s"), 0.5);
  EXPECT_EQ(table.number("frequency", kPositive, "Hz"), 50.0);
  EXPECT_EQ(read_any_direction(table, "direction"), Eigen::Vector3d::UnitY());
}

TEST(AngularUnitsTest, ASentenceSaysTheUnitAndTheBoundsOfARotation) {
  Knob knob("stiffness = -1.0\n");
  knob.table().number("stiffness", {0.0, 1e5}, "N/m");
  EXPECT_EQ(
      test::message_of([&] { knob.document.finish(); }),
      "k.toml:2: knob.stiffness is -1; allowed: a number of at least 0 and at most 40 [N·m/rad]");
}

TEST(AngularUnitsTest, OtherTablesAreNotTouched) {
  Table document = Table::parse("[knob]\nx = 1.0\n[wall]\nx = 1.0\n", "k.toml");
  document.table("knob").state_in(AngularUnits(kRadius));
  EXPECT_EQ(document.table("wall").number("x", kPositive, "m"), 1.0);
  EXPECT_EQ(document.table("knob").number("x", kPositive, "m"), kRadius);
}

}  // namespace
}  // namespace haptrial
