#include "core/bone/region/forbidden_region.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <span>
#include <vector>

#include "core/base/error.h"
#include "core/base/random.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/message_of.h"

namespace haptrial::bone::forbidden_region_test {
namespace {

using Eigen::Vector3d;

constexpr double kVoxel = 0.5e-3;
constexpr double kNerve = 3e-3;  // radius of the nerve, a cylinder along z [m]
const Vector3d kAxis = Vector3d::UnitZ();
const BurrShape::Ball kBurr[] = {{0.0, 2e-3}};

/// Bone with a nerve along z through the origin of x and y.
BoneModel bone_with_nerve() {
  BoneModel model;
  model.name = "block";
  model.grid = {{61, 61, 41}, {-15e-3, -15e-3, -10e-3}, kVoxel};
  model.structures = {{}, {"bone"}, {"facial nerve", {}, 0.5, true}};
  for (int k = 0; k < 41; ++k) {
    for (int j = 0; j < 61; ++j) {
      for (int i = 0; i < 61; ++i) {
        const Vector3d at = model.grid.centre(i, j, k);
        model.labels.push_back(at.head<2>().norm() < kNerve ? 2 : 1);
      }
    }
  }
  return model;
}

RegionSetup setup_of(RegionKind kind) {
  RegionSetup setup;
  setup.structures = {"facial nerve"};
  setup.kind = kind;
  return setup;
}

ForbiddenRegion region_of(const RegionSetup& setup) {
  static const BoneModel bone = bone_with_nerve();
  return {setup, std::make_shared<const RegionMap>(setup, bone, 2e-3)};
}

/// The burr is outside, so that it is felt from now on.
void leave(ForbiddenRegion& region) { region.tick(kBurr, Vector3d(14e-3, 0, 0), kAxis); }

TEST(ForbiddenRegionTest, TheForceIsThatOfASpringFromTheMarginOn) {
  const RegionSetup setup = setup_of(RegionKind::kHard);
  ForbiddenRegion region = region_of(setup);
  leave(region);
  // The burr's surface is in the margin from nerve + margin + burr = 7 mm from the axis on.
  for (const double depth : {-0.5e-3, 0.5e-3, 1e-3, 2e-3}) {
    const Vector3d force = region.tick(kBurr, Vector3d(7e-3 - depth, 0, 0), kAxis);
    const double expected = std::max(0.0, setup.spring() * depth);
    EXPECT_NEAR(force.x(), expected, setup.spring() * 0.6 * kVoxel) << depth;
    EXPECT_LT(force.tail<2>().norm(), 0.05) << depth;
    EXPECT_NEAR(region.depths()[0], std::max(0.0, depth), 0.6 * kVoxel);
  }
}

// A region around nothing would be one that nobody meets.
TEST(ForbiddenRegionTest, AStructureWithoutVoxelsIsRefused) {
  BoneModel bone = bone_with_nerve();
  bone.structures.push_back({"tooth"});
  RegionSetup setup = setup_of(RegionKind::kHard);
  setup.structures = {"tooth"};
  EXPECT_EQ(haptrial::test::message_of([&] { RegionMap(setup, bone, 2e-3); }),
            "forbidden: the bone block has no structure 'tooth'; it has bone, facial nerve");
}

TEST(ForbiddenRegionTest, TheForceIsTheGradientOfItsEnergy) {
  for (const RegionKind kind : {RegionKind::kSoft, RegionKind::kHard}) {
    ForbiddenRegion region = region_of(setup_of(kind));
    RandomStream random(1, "places");
    int inside = 0;
    for (int n = 0; n < 400; ++n) {
      const double angle = random.uniform(0.0, 2.0 * std::numbers::pi);
      const double away = random.uniform(3.5e-3, 8e-3);
      const Vector3d at(away * std::cos(angle), away * std::sin(angle),
                        random.uniform(-5e-3, 5e-3));
      leave(region);
      const Vector3d force = region.tick(kBurr, at, kAxis);
      constexpr double kStep = 1e-9;
      for (int axis = 0; axis < 3; ++axis) {
        const Vector3d aside = kStep * Vector3d::Unit(axis);
        const double slope =
            (region.energy(kBurr, at + aside, kAxis) - region.energy(kBurr, at - aside, kAxis)) /
            (2.0 * kStep);
        EXPECT_NEAR(force[axis], -slope, 2e-4) << at.transpose();
      }
      inside += force.norm() > 0.0 ? 1 : 0;
    }
    EXPECT_GT(inside, 200);
  }
}

TEST(ForbiddenRegionTest, NothingIsGainedOnAClosedPath) {
  ForbiddenRegion region = region_of(setup_of(RegionKind::kHard));
  leave(region);
  double work = 0.0, moved = 0.0;
  Vector3d before(9e-3, 0, 0);
  constexpr int kSteps = 200'000;
  for (int n = 1; n <= kSteps; ++n) {  // a loop in and out of the region, three times around
    const double t = 2.0 * std::numbers::pi * n / kSteps;
    const double away = 6.5e-3 + 2.5e-3 * std::cos(5.0 * t);
    const Vector3d now(away * std::cos(3.0 * t), away * std::sin(3.0 * t),
                       3e-3 * std::sin(2.0 * t));
    const Vector3d force = region.tick(kBurr, 0.5 * (before + now), kAxis);
    work += force.dot(now - before);
    moved += std::abs(force.dot(now - before));
    before = now;
  }
  EXPECT_GT(moved, 1e-2);
  EXPECT_LT(std::abs(work), 1e-5 * moved);
}

TEST(ForbiddenRegionTest, TheForceGrowsWithoutAStepAndUpToItsLimit) {
  RegionSetup setup = setup_of(RegionKind::kHard);
  setup.force_limit = 1.2;
  ForbiddenRegion region = region_of(setup);
  leave(region);
  double before = 0.0, most = 0.0;
  for (double away = 12e-3; away > 3.2e-3; away -= 1e-6) {
    const double force = region.tick(kBurr, Vector3d(away, 1e-4, 2e-4), kAxis).norm();
    if (region.depths()[0] < 1e-5) {
      EXPECT_LT(std::abs(force - before), 2.0 * setup.spring() * 1e-6);
    }
    before = force;
    most = std::max(most, force);
  }
  EXPECT_GT(most, 1.0);
  EXPECT_LE(most, 1.2 * 1.001);  // the smoothed distance's slope is 1 at most
}

/// Bone with two walls of dura, whose surfaces are at x = ±3.25 mm.
BoneModel bone_with_groove() {
  BoneModel model = bone_with_nerve();
  model.structures[2].name = "sigmoid sinus and dura";
  for (std::size_t at = 0; at < model.labels.size(); ++at) {
    const double x = model.grid.origin.x() + kVoxel * static_cast<double>(at % 61);
    model.labels[at] = std::abs(x) > 3.25e-3 ? 2 : 1;
  }
  return model;
}

// Each wall alone pushes by k (r + m - its distance). In the middle the nearer one changes.
TEST(ForbiddenRegionTest, BetweenTwoSidesTheForceTurnsWithoutAStep) {
  RegionSetup setup = setup_of(RegionKind::kHard);
  setup.structures = {"dura"};
  ForbiddenRegion region(setup, std::make_shared<const RegionMap>(setup, bone_with_groove(), 2e-3));
  const BurrShape::Ball small[] = {{0.0, 0.5e-3}};
  region.tick(small, Vector3d(0.0, 0.0, 0.0), kAxis);  // 0.75 mm off the margins: felt from now on
  constexpr double kStep = 1e-6;
  Vector3d before = region.tick(kBurr, Vector3d(-2.5e-3, 1e-4, 2e-4), kAxis);
  for (int i = 1; i <= 5000; ++i) {
    const double x = -2.5e-3 + i * kStep;
    const Vector3d force = region.tick(kBurr, Vector3d(x, 1e-4, 2e-4), kAxis);
    const double depth = 2e-3 + setup.margin - (3.25e-3 - std::abs(x));
    const double push = std::min(setup.spring() * depth, setup.most_force());
    // The slope of the distance turns by 2 within a voxel at most.
    ASSERT_LT((force - before).norm(), (2.0 * setup.most_force() / kVoxel + setup.spring()) * kStep)
        << x;
    EXPECT_LE(force.norm(), push + setup.spring() * kVoxel);
    if (std::abs(x) > 1.3e-3) {  // the smoothing reaches 2.5 voxels
      EXPECT_NEAR(force.x(), x > 0.0 ? -push : push, 1e-3) << x;
    }
    before = force;
  }
  EXPECT_NEAR(region.tick(kBurr, Vector3d(0.0, 1e-4, 2e-4), kAxis).norm(), 0.0, 1e-3);
}

/// A rod that lies across a groove meets a wall with either end; in the middle both push alike.
TEST(ForbiddenRegionTest, ARodBetweenTwoSidesIsHandedOverWithoutAStep) {
  RegionSetup setup = setup_of(RegionKind::kHard);
  setup.structures = {"dura"};
  ForbiddenRegion region(setup, std::make_shared<const RegionMap>(setup, bone_with_groove(), 2e-3));
  const BurrShape::Ball small[] = {{0.0, 0.5e-3}};
  const BurrShape::Ball rod[] = {{-1.5e-3, 1e-3}, {0.0, 1e-3}, {1.5e-3, 1e-3}};
  const Vector3d along = Vector3d::UnitX();
  region.tick(small, Vector3d::Zero(), along);  // felt from now on
  constexpr double kStep = 1e-6;
  const auto force_at = [&](double x) { return region.tick(rod, Vector3d(x, 1e-4, 2e-4), along); };
  const auto energy_at = [&](double x) {
    return region.energy(rod, Vector3d(x, 1e-4, 2e-4), along);
  };
  Vector3d before = force_at(-1.5e-3);
  EXPECT_GT(before.x(), 1.5);
  double steepest = 0.0;
  for (int i = 1; i <= 3000; ++i) {
    const double x = -1.5e-3 + i * kStep;
    const Vector3d force = force_at(x);
    const double depth = 3e-3 - (3.25e-3 - 1.5e-3 - std::abs(x));  // of the deeper end
    EXPECT_NEAR(region.depths()[0], depth, 0.1 * kVoxel);
    EXPECT_LE(force.norm(), setup.spring() * depth + 0.05);
    EXPECT_NEAR(force.x(), (energy_at(x - kStep) - energy_at(x + kStep)) / (2.0 * kStep), 1e-2);
    steepest = std::max(steepest, (force - before).norm() / kStep);
    before = force;
  }
  EXPECT_LT(steepest, 40e3);  // [N/m]; a step of 2.5 N would be 2.5e6
  EXPECT_NEAR(force_at(0.0).norm(), 0.0, 1e-3);
}

/// A long burr that meets the nerve with its tip is held as its first ball alone; one that lies
/// along the nerve has no more than 9^(1/32) of the depth and of the limit.
TEST(ForbiddenRegionTest, TheTipOfALongBurrIsHeldAsStiffAsABall) {
  const RegionSetup setup = setup_of(RegionKind::kHard);
  ForbiddenRegion region = region_of(setup);
  std::vector<BurrShape::Ball> burr;
  for (int i = 0; i < 9; ++i) {
    burr.push_back({0.75e-3 * i, 1e-3});
  }
  const auto force_at = [&](std::span<const BurrShape::Ball> balls, double depth,
                            const Vector3d& axis) {
    region.forget();
    leave(region);
    return region.tick(balls, Vector3d(kNerve + 1e-3 + setup.margin - depth, 0, 0), axis).x();
  };
  const double most = std::pow(9.0, 1.0 / 32.0);
  for (const double depth : {0.5e-3, 1e-3, 2e-3, 3e-3, 4.5e-3}) {
    const double ball = force_at(std::span(burr).first(1), depth, Vector3d::UnitX());
    EXPECT_NEAR(force_at(burr, depth, Vector3d::UnitX()), ball, 1e-3 * ball) << depth;
    EXPECT_GE(force_at(burr, depth, kAxis), 0.99 * ball) << depth;
    EXPECT_LE(force_at(burr, depth, kAxis), 1.01 * most * most * ball) << depth;
  }
}

TEST(ForbiddenRegionTest, ABurrThatIsInsideWhenItIsTakenIsNotThrownOut) {
  ForbiddenRegion region = region_of(setup_of(RegionKind::kHard));
  const Vector3d inside(5.5e-3, 0, 0);
  EXPECT_EQ(region.tick(kBurr, inside, kAxis).norm(), 0.0);
  EXPECT_GT(region.depths()[0], 1e-3);
  leave(region);
  EXPECT_GT(region.tick(kBurr, inside, kAxis).norm(), 0.5);
  region.forget();
  EXPECT_EQ(region.tick(kBurr, inside, kAxis).norm(), 0.0);
}

TEST(ForbiddenRegionTest, ARegionThatOnlySoundsAndAToolThatIsNoBurrFeelNothing) {
  ForbiddenRegion sound = region_of(setup_of(RegionKind::kSound));
  leave(sound);
  EXPECT_EQ(sound.tick(kBurr, Vector3d(5e-3, 0, 0), kAxis).norm(), 0.0);
  EXPECT_GT(sound.depths()[0], 1e-3);
  ForbiddenRegion hard = region_of(setup_of(RegionKind::kHard));
  leave(hard);
  EXPECT_EQ(hard.tick({}, Vector3d(5e-3, 0, 0), kAxis).norm(), 0.0);
  EXPECT_EQ(hard.depths()[0], 0.0);
}

TEST(ForbiddenRegionTest, ATickDoesNotAllocate) {
  ForbiddenRegion region = region_of(setup_of(RegionKind::kSoft));
  CrossingWatch watch({2});
  realtime::BlockLog<record::CrossingRow> log(64, 16);
  std::size_t counted = 0;
  {
    const test::AllocationGuard guard;
    for (std::uint64_t n = 0; n < 1000; ++n) {
      const double away = 7e-3 + 2e-3 * std::cos(0.02 * static_cast<double>(n));
      region.tick(kBurr, Vector3d(away, 0, 0), kAxis);
      watch.after_tick(n, true, region.depths(), log);
    }
    region.forget();
    counted = guard.count();
  }
  EXPECT_EQ(counted, 0u);
}

TEST(ForbiddenRegionTest, AStructureThatIsNotThereIsRefused) {
  RegionSetup setup = setup_of(RegionKind::kSoft);
  setup.structures = {"incus"};
  EXPECT_THAT(test::message_of<InputError>([&] { region_of(setup); }), testing::HasSubstr("incus"));
}

TEST(CrossingWatchTest, CrossingsHaveTheirTicksAndGreatestDepth) {
  CrossingWatch watch({2, 3});
  realtime::BlockLog<record::CrossingRow> log(64, 16);
  const double depths[][2] = {{0, 0},    {1e-3, 0}, {2e-3, 0}, {1e-3, 4e-3},
                              {0, 5e-3}, {0, 0},    {3e-3, 0}};
  std::vector<bool> entered;
  for (std::uint64_t n = 0; n < std::size(depths); ++n) {
    entered.push_back(watch.after_tick(100 + n, n != 6, depths[n], log));
  }
  watch.end(log);
  std::vector<record::CrossingRow> rows;
  log.flush([&](std::span<const record::CrossingRow> some) {
    rows.insert(rows.end(), some.begin(), some.end());
  });
  EXPECT_EQ(entered, std::vector<bool>({false, true, false, true, false, false, true}));
  ASSERT_EQ(rows.size(), 3u);
  const auto expect_row = [&](std::size_t n, std::uint64_t begin, std::uint64_t end,
                              std::uint8_t label, double depth, bool given) {
    EXPECT_EQ(rows[n].begin, begin);
    EXPECT_EQ(rows[n].sequence, end);
    EXPECT_EQ(rows[n].label, label);
    EXPECT_EQ(rows[n].depth, depth);
    EXPECT_EQ(rows[n].given, given);
  };
  expect_row(0, 101, 103, 2, 2e-3, true);
  expect_row(1, 103, 104, 3, 5e-3, true);
  expect_row(2, 106, 106, 2, 3e-3, false);
}

}  // namespace
}  // namespace haptrial::bone::forbidden_region_test
