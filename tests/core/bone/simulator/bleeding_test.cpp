#include "core/bone/simulator/bleeding.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/definition/schema.h"
#include "tests/support/message_of.h"

namespace haptrial::bone::bleeding_test {
namespace {

constexpr double kEdge = 0.4e-3;
constexpr double kRate = 3e-8;  // [m3/s]

BoneModel bone_with_a_sinus() {
  BoneModel model;
  model.name = "block";
  model.grid = {{4, 4, 4}, {0.0, 0.0, 0.0}, kEdge};
  model.structures = {{}, {"bone", {}}, {"sigmoid sinus and dura", {}, 0.25, true}};
  model.labels.assign(64, 2);
  return model;
}

double flowed(Bleeding& bleeding, int ticks, double dt) {
  double voxels = 0.0;
  for (int i = 0; i < ticks; ++i) {
    bleeding.begin_tick();
    bleeding.tick(Eigen::Isometry3d::Identity(), dt);
    for (const DustDeposit& deposit : bleeding.deposits()) {
      voxels += deposit.amount;
    }
  }
  return voxels * kEdge * kEdge * kEdge;
}

TEST(BleedingTest, EachOpeningBleedsAtItsRateWhereItIs) {
  Bleeding bleeding(bone_with_a_sinus(), {{"sigmoid sinus"}, kRate});
  EXPECT_EQ(flowed(bleeding, 1000, 1e-3), 0.0);
  bleeding.begin_tick();
  bleeding.open(2, {0.0, 0.0, 0.0});
  bleeding.open(1, {0.1, 0.0, 0.0});                     // bone does not bleed
  bleeding.open(2, {0.9 * Bleeding::kApart, 0.0, 0.0});  // the same place
  bleeding.open(2, {1.1 * Bleeding::kApart, 0.0, 0.0});
  ASSERT_EQ(bleeding.begun().size(), 2u);
  EXPECT_EQ(bleeding.begun()[1].place_B.x(), 1.1 * Bleeding::kApart);
  const double late = 2.0 * kRate * 1e-3 * Bleeding::kBetween;  // what is owed at the end
  EXPECT_NEAR(flowed(bleeding, 10'000, 1e-3), 2.0 * kRate * 10.0, late);
  EXPECT_TRUE(bleeding.begun().empty());
}

TEST(BleedingTest, ItFlowsFromTheBoneWhereverThatLies) {
  Bleeding bleeding(bone_with_a_sinus(), {{"dura"}, kRate});
  bleeding.open(2, {0.001, 0.002, 0.003});
  const Eigen::Isometry3d pose =
      Eigen::Translation3d(0.1, 0.2, 0.3) * Eigen::AngleAxisd(1.0, Eigen::Vector3d::UnitY());
  for (std::uint64_t i = 0; i < Bleeding::kBetween; ++i) {
    bleeding.begin_tick();
    bleeding.tick(pose, 1e-3);
    for (const DustDeposit& deposit : bleeding.deposits()) {
      EXPECT_LT((deposit.centre - pose * Eigen::Vector3d(0.001, 0.002, 0.003)).norm(), 1e-15);
    }
  }
}

TEST(BleedingTest, ThereIsRoomForSoManyOpenings) {
  Bleeding bleeding(bone_with_a_sinus(), {{"dura"}, kRate});
  for (int i = 0; i < 100; ++i) {
    bleeding.open(2, {2.0 * Bleeding::kApart * i, 0.0, 0.0});
  }
  EXPECT_EQ(bleeding.openings(), Bleeding::kMost);
}

TEST(BleedingTest, AKnownVesselThatThisBoneLacksDoesNotBleed) {
  const BleedingParameters parameters{{"internal carotid artery", "sigmoid sinus"}, kRate};
  EXPECT_NO_THROW(check_bleeding(bone_with_a_sinus(), parameters));
  Bleeding bleeding(bone_with_a_sinus(), parameters);
  EXPECT_FALSE(bleeding.bleeds(1));
  EXPECT_TRUE(bleeding.bleeds(2));
}

TEST(BleedingTest, AStructureThatTheBoneLacksIsNamed) {
  EXPECT_THAT(test::message_of([] {
                check_bleeding(bone_with_a_sinus(), {{"sigmoid snus"}, kRate});
              }),
              testing::AllOf(testing::HasSubstr("sigmoid snus"),
                             testing::HasSubstr("sigmoid sinus and dura")));
  Table root = Table::parse("[bleeding]\nstructures = []\n", "a.toml");
  Table table = root.table("bleeding");
  bleeding_schema().read(table);
  EXPECT_THAT(test::message_of([&] { root.finish(); }), testing::HasSubstr("structures"));
}

}  // namespace
}  // namespace haptrial::bone::bleeding_test
