// A straight approach to a structure at known force and distance.

#include "analysis/bone_drilling/metrics/near_structure.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/analysis/bone_drilling/hand_made.h"

namespace haptrial::analysis::drilling {
namespace {

/// 41 voxels of 1 mm in a row with the nerve in the first: voxel i is i mm away.
bone::BoneModel row_to_nerve() {
  bone::BoneModel model = test::block(41, 1, 1);
  model.structures.push_back({"nerve", {}, 1.0, true});
  test::mark(model, {0, 0, 0}, 2);
  return model;
}

/// Removes voxels 40 .. 1 with a force and speed by distance [mm].
template <class Force>
Procedure approach(const std::string& participant, Force force) {
  Procedure p = test::procedure_on(row_to_nerve());
  p.participant = participant;
  for (int i = 40; i >= 1; --i) {
    test::remove_in_turn(p, {{i, 0, 0}}, force(i), 0.001 * i);
  }
  return p;
}

NearRemovals near(const Procedure& p, const NearBins& bins = {}) {
  return near_removals(p, "nerve", bone::DistanceField(*p.bone, {false, false, true}, bins.reach),
                       bins.reach);
}

TEST(NearStructureTest, AStraightApproachGivesItsForcesByDistance) {
  const NearRemovals found = near(approach("A", [](int mm) { return 0.1 * mm; }));
  ASSERT_EQ(found.removals.size(), 30u) << "of 1 to 30 mm";
  for (const NearRemoval& removal : found.removals) {
    EXPECT_NEAR(removal.force, 100.0F * removal.distance, 1e-6);
    EXPECT_NEAR(removal.speed, removal.distance, 1e-8);
  }
  EXPECT_NEAR(*found.mean_force(5e-3), 0.3, 1e-7) << "of 1 to 5 mm";
  EXPECT_NEAR(*found.mean_speed(2e-3), 1.5e-3, 1e-9);
  EXPECT_FALSE(found.mean_force(0.5e-3));
}

TEST(NearStructureTest, BinsHaveTheMeansOfTheirDistances) {
  const NearRemovals a = near(approach("A", [](int mm) { return 0.1 * mm; }));
  const NearRemovals b = near(approach("B", [](int mm) { return 0.1 * mm + 0.2; }));
  const std::vector<NearCase> group{{"A", &a}, {"B", &b}};
  const auto profile = near_profile(group, NearQuantity::kForce);
  ASSERT_EQ(profile.size(), 15u);
  // [0, 2) mm holds the voxel at 1 mm, [2n, 2n + 2) those at 2n and 2n + 1.
  EXPECT_EQ(profile[0].removals, 2u);
  for (std::size_t n = 1; n < 15; ++n) {
    const double middle = 0.1 * (2.0 * static_cast<double>(n) + 0.5);
    EXPECT_EQ(profile[n].removals, 4u);
    EXPECT_EQ(profile[n].participants, 2u);
    EXPECT_NEAR(profile[n].low, 2e-3 * static_cast<double>(n), 1e-12);
    EXPECT_NEAR(profile[n].pooled->mean, middle + 0.1, 1e-6);
    EXPECT_NEAR(profile[n].by_participant->mean, middle + 0.1, 1e-6);
    // Two means 0.2 apart: standard error 0.1; Student's t of one degree of freedom is 12.706.
    EXPECT_NEAR(profile[n].by_participant->high - profile[n].by_participant->mean, 1.2706, 1e-4);
    // Forces -0.15, -0.05, 0.05, 0.15 about their mean: s^2 = 0.05 / 3; t of three is 3.1824.
    EXPECT_NEAR(profile[n].pooled->high - profile[n].pooled->mean,
                3.18245 * std::sqrt(0.05 / 3.0 / 4.0), 1e-4);
  }
}

TEST(NearStructureTest, EveryParticipantCountsOnce) {
  const NearRemovals few = near(approach("few", [](int) { return 1.0; }));
  NearRemovals many;
  for (int n = 0; n < 1000; ++n) {
    many.removals.push_back({0.5e-3F, 3.0F, 0.01F});
  }
  const std::vector<NearCase> group{{"few", &few}, {"many", &many}, {"many", &many}};
  const ProfileBin bin = near_profile(group, NearQuantity::kForce)[0];
  EXPECT_EQ(bin.removals, 2001u);
  EXPECT_EQ(bin.participants, 2u);
  EXPECT_NEAR(bin.by_participant->mean, 2.0, 1e-9);
  EXPECT_NEAR(bin.pooled->mean, (1.0 + 6000.0) / 2001.0, 1e-9);
}

TEST(NearStructureTest, WhatIsNotThereIsSaid) {
  const NearRemovals one = near(approach("one", [](int) { return 1.0; }));
  const std::vector<NearCase> alone{{"one", &one}};
  const auto profile = near_profile(alone, NearQuantity::kSpeed);
  EXPECT_FALSE(profile[3].by_participant) << "one participant has no interval";
  EXPECT_TRUE(profile[3].pooled);
  EXPECT_FALSE(near_profile({}, NearQuantity::kForce)[0].pooled);
  EXPECT_THROW(NearBins({0.0, 0.03}).count(), std::invalid_argument);
  EXPECT_THROW(NearBins({0.02, 0.01}).count(), std::invalid_argument);
  EXPECT_EQ(NearBins{}.count(), 15u);
}

}  // namespace
}  // namespace haptrial::analysis::drilling
