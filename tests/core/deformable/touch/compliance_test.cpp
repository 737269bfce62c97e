#include "core/deformable/touch/compliance.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/base/error.h"
#include "core/deformable/elements/static_solver.h"
#include "core/deformable/touch/prepared.h"
#include "core/geometry/mesh/procedural.h"
#include "tests/core/deformable/touch/soft_block.h"
#include "tests/support/message_of.h"

namespace haptrial::deformable::compliance_test {
namespace {

using Eigen::Vector3d;
using test::soft_block;
using test::soft_tissue;
using testing::HasSubstr;

LoadCase small_load(const Compliance& body, std::int32_t place) {
  const HapticMesh& mesh = body.mesh();
  LoadCase load;
  load.name = "small";
  for (std::size_t v = 0; v < mesh.held.size(); ++v) {
    if (mesh.held[v] != 0) {
      load.holds.push_back({static_cast<std::int32_t>(v), Vector3d::Zero()});
    }
  }
  load.forces.push_back({body.vertex(place), {1e-3, -2e-3, 5e-4}});
  return load;
}

double largest_error(const Compliance& body, const Tissue& tissue, std::int32_t place) {
  const ElasticBody elements(body.mesh().tets, elasticity_of(body.mesh(), tissue));
  const StaticResult rest = solve_static(elements, small_load(body, place), {1e-12});
  double error = 0.0;
  double most = 0.0;
  for (std::size_t p = 0; p < body.places(); ++p) {
    const auto at = static_cast<std::int32_t>(p);
    const Vector3d exact = rest.displacement[static_cast<std::size_t>(body.vertex(at))];
    const Vector3d u = body.response(at, place, {1e-3F, -2e-3F, 5e-4F}).cast<double>();
    error = std::max(error, (u - exact).norm());
    most = std::max(most, exact.norm());
  }
  return error / most;
}

/// Nested dissection and dense inverses against the elements' own statics.
TEST(ComplianceTest, RespondsAsTheElements) {
  Tissue tissue = soft_tissue();
  tissue.inclusions = {{"lump", {0.008, 0.004, 0.008}, 0.006, 300e3}};
  const Compliance body(soft_block(), tissue);
  for (const std::size_t place : {std::size_t{0}, body.touched() / 3, body.touched() - 1}) {
    EXPECT_LT(largest_error(body, tissue, static_cast<std::int32_t>(place)), 1e-5) << place;
  }
}

TEST(ComplianceTest, AVoxelBodyTouchedAllOverRespondsAsTheElements) {
  const auto mesh = std::make_shared<const HapticMesh>(
      felt_solid(geometry::make_sphere(0.02, 8), 10, FeltSides{}, "ball"));
  const Compliance body(mesh, soft_tissue());
  EXPECT_GT(body.touched(), body.places() / 4);
  EXPECT_LT(largest_error(body, soft_tissue(), static_cast<std::int32_t>(body.touched() / 2)),
            1e-5);
}

TEST(ComplianceTest, ABodyOneCellThickRespondsAsTheElements) {
  for (const Vector3d& size : {Vector3d(0.06, 0.04, 0.006), Vector3d(0.04, 0.006, 0.06)}) {
    const auto mesh = std::make_shared<const HapticMesh>(felt_block(size, 10, FeltSides{}, "skin"));
    const Compliance body(mesh, soft_tissue());
    const auto is_held = [&](std::size_t place) {
      return mesh->held[static_cast<std::size_t>(body.vertex(static_cast<std::int32_t>(place)))];
    };
    for (std::size_t below = body.touched(); below < body.places(); ++below) {
      EXPECT_TRUE(is_held(below)) << "nothing that moves lies below the surface";
    }
    std::size_t loaded = body.touched() / 2;
    while (is_held(loaded)) {
      ++loaded;
    }
    EXPECT_LT(largest_error(body, soft_tissue(), static_cast<std::int32_t>(loaded)), 1e-5);
  }
}

TEST(ComplianceTest, AHeldPlaceDoesNotMoveAndABallThatReachesItHasNoBound) {
  FeltSides sides;  // all but the bottom: the sides reach down to held vertices
  const auto mesh =
      std::make_shared<const HapticMesh>(felt_block({0.02, 0.01, 0.02}, 6, sides, "small"));
  const Compliance body(mesh, soft_tissue());
  bool found = false;
  for (std::size_t p = 0; p < body.touched(); ++p) {
    const auto place = static_cast<std::int32_t>(p);
    if (mesh->held[static_cast<std::size_t>(body.vertex(place))] != 0) {
      found = true;
      EXPECT_EQ(body.response(place, place, {1.0F, 1.0F, 1.0F}).norm(), 0.0F);
    }
  }
  EXPECT_TRUE(found);
  EXPECT_TRUE(std::isinf(body.stiffest(0.005)));
}

TEST(ComplianceTest, TheSameBodyIsPreparedOnce) {
  const auto first = prepared(soft_block(6), soft_tissue());
  EXPECT_EQ(first, prepared(soft_block(6), soft_tissue()));
  Tissue firm = soft_tissue();
  firm.young *= 1.3;
  EXPECT_EQ(&first->mesh(), &prepared(soft_block(6), firm)->mesh()) << "for BallTouch::adopt()";
  Tissue other = soft_tissue();
  other.young *= 2.0;
  EXPECT_NE(first, prepared(soft_block(6), other));
}

TEST(HapticMeshTest, BadBodiesAreRefusedInASentence) {
  FeltSides loose;
  loose.fixed.clear();
  EXPECT_THAT(test::message_of([&] {
                felt_block({0.02, 0.02, 0.02}, 4, loose, "loose");
              }),
              HasSubstr("loose: nothing holds the body; name a side in `fixed`"));
  EXPECT_THAT(test::message_of([&] {
                felt_block({0.1, 0.001, 0.1}, 4, FeltSides{}, "sheet");
              }),
              HasSubstr("sheet: its cells are 0.025 x 0.001 x 0.025 m, which is too flat"));
  EXPECT_THAT(test::message_of([&] {
                felt_block({0.1, 0.1, 0.1}, 200, FeltSides{}, "fine");
              }),
              HasSubstr("fine: cells = 200 make about 8120601 vertices; allowed: up to 100000"));
  EXPECT_THAT(test::message_of([&] {
                felt_solid(geometry::make_box({0.1, 0.1, 0.1}), 120, FeltSides{}, "filled");
              }),
              HasSubstr("filled: cells = 120 make about 1728000 vertices"));
  FeltSides hidden;
  hidden.felt = hidden.fixed;
  EXPECT_THAT(test::message_of([&] {
                felt_block({0.02, 0.02, 0.02}, 4, hidden, "hidden");
              }),
              HasSubstr("hidden: no face can be touched"));
}

TEST(TissueTest, BadTissuesAreRefusedInASentence) {
  const SharedHapticMesh mesh = soft_block(6);
  const auto says = [&](const Tissue& tissue) {
    return test::message_of([&] { check_tissue(*mesh, tissue); });
  };
  EXPECT_THAT(says({0.0, 0.45, 1000.0, {}}), HasSubstr("block: young is 0; allowed: above 0"));
  EXPECT_THAT(says({1e4, 0.5, 1000.0, {}}),
              HasSubstr("block: poisson is 0.5; allowed: 0 to 0.499"));
  EXPECT_THAT(
      says({1e4, 0.4, 1000.0, {{"lump", {0.02, 0.0, 0.0}, 0.005, 1e5}}}),
      HasSubstr("the inclusion lump at (0.02, 0, 0) m with a radius of 0.005 m does not lie "
                "within the body"));
  EXPECT_THAT(says({1e4, 0.4, 1000.0, {{"lump", {0.0, 0.0, 0.0}, 0.005, 0.0}}}),
              HasSubstr("inclusion lump: young is 0; allowed: above 0"));
  EXPECT_EQ(says({1e4, 0.4, 1000.0, {{"lump", {9.0, 9.0, 9.0}, 0.0, 1e5}}}), "nothing was thrown");
}

TEST(TissueTest, SharesOfABallSumToItsVolume) {
  const SharedHapticMesh mesh = soft_block(12);
  const double voxel = 0.004 * 0.004 * 0.004;
  for (const double radius : {0.003, 0.006, 0.009}) {
    double sum = 0.0;
    const std::vector<double> shares = shares_in_ball(*mesh, {0.001, 0.0005, -0.002}, radius);
    for (std::size_t first = 0; first < shares.size(); first += 5) {
      sum += shares[first] * voxel;
    }
    const double exact = 4.0 / 3.0 * std::numbers::pi * std::pow(radius, 3);
    EXPECT_NEAR(sum / exact, 1.0, 0.02) << radius;
  }
}

}  // namespace
}  // namespace haptrial::deformable::compliance_test
