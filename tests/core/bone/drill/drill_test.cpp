#include "core/bone/drill/drill.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/base/random.h"
#include "core/bone/drill/feel.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/solid_bone.h"

namespace haptrial::bone::drill_test {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double kSpacing = 1.0 / 2048;  // about 0.5 mm, and exact in doubles

Quaterniond random_turn(RandomStream& random) {
  return Quaterniond(random.normal(), random.normal(), random.normal(), random.normal())
      .normalized();
}

/// Bone full of holes, so that every look-up matters.
BoneModel sponge(std::uint64_t seed) {
  RandomStream random(seed, "sponge");
  return test::solid_bone(40, kSpacing,
                          [&](const Vector3d& p) { return p.z() < 4e-3 && random.below(3) != 0; });
}

void expect_same(const Contact& a, const Contact& b) {
  EXPECT_EQ(a.samples, b.samples);
  EXPECT_EQ(a.kept, b.kept);
  EXPECT_EQ(a.push, b.push);
  EXPECT_EQ(a.turn, b.turn);
  EXPECT_EQ(a.centroid, b.centroid);
}

TEST(DrillTest, MeetsTheVolumeOfASphericalCap) {
  const BoneVolume bone(test::flat_bone(40, kSpacing));
  RandomStream random(1, "caps");
  for (const double diameter : {2e-3, 4e-3, 7e-3}) {
    Drill drill(default_burr(BurrKind::kDiamond, diameter), {});
    const double r = 0.5 * diameter;
    double before = 0.0;
    for (int n = 1; n <= 10; ++n) {
      const double d = 0.1 * n * diameter;
      const Contact c = drill.touch(bone, Vector3d(0, 0, r - d), random_turn(random));
      const double cap = std::numbers::pi * d * d * (r - d / 3.0);
      EXPECT_NEAR(c.volume, cap, 0.01 * cap + 30 * drill.burr().sample_volume());
      EXPECT_GT(c.volume, before);
      before = c.volume;
      drill.begin_tick();
    }
  }
}

TEST(DrillTest, ThePushOfAHalfSpaceIsItsNormal) {
  // The components across are what sampling makes of zero.
  const BoneVolume bone(test::flat_bone(40, kSpacing));
  Drill drill(default_burr(BurrKind::kDiamond, 4e-3), {});
  RandomStream random(2, "normals");
  for (int n = 0; n < 30; ++n) {
    drill.begin_tick();
    const double d = random.uniform(0.3e-3, 2e-3);
    const Vector3d tip(random.uniform(-2e-3, 2e-3), random.uniform(-2e-3, 2e-3), 2e-3 - d);
    const Contact c = drill.touch(bone, tip, random_turn(random));
    EXPECT_GT(c.push.normalized().z(), std::cos(0.03));
    EXPECT_LT(c.centroid.z(), 0.0);
    EXPECT_GT(c.centroid.z(), -d);
  }
}

/// Result of touch(), by brute force in doubles, and the number of samples that lie so near to a
/// face between voxels that rounding decides.
struct Brute {
  int samples{0};
  int unsure{0};
  Vector3d push{Vector3d::Zero()};
  Vector3d turn{Vector3d::Zero()};
};

Brute brute_force(const Burr& burr, const BoneVolume& bone, const Vector3d& tip,
                  const Quaterniond& turn) {
  Brute sum;
  const geometry::VoxelGrid& grid = bone.grid();
  for (std::int32_t n = 0; n < burr.samples(); ++n) {
    const Vector3d s = turn * burr.position(n);
    const Eigen::Array3d at = ((tip + s - grid.origin) / grid.spacing).array() + 0.5;
    sum.unsure += ((at - at.round()).abs() < 2e-3).any();
    const Eigen::Array3d low = at.floor();
    if (!(bone.density(Voxel(low.cast<int>().matrix())) > 0.0F)) {
      continue;
    }
    ++sum.samples;
    sum.push += burr.sample_volume() * -s.normalized();
    const Vector3d d = turn * Vector3d::UnitZ();
    sum.turn += burr.sample_volume() * (s - d * d.dot(s)).cross(d);
  }
  return sum;
}

TEST(DrillTest, AgreesWithBruteForceInDoubles) {
  const BoneVolume bone(sponge(3));
  Drill drill(default_burr(BurrKind::kCutting, 4.4e-3), {});
  RandomStream random(3, "poses");
  const double v = drill.burr().sample_volume();
  const double r = drill.burr().radius();
  for (int n = 0; n < 60; ++n) {
    drill.begin_tick();
    const auto along = [&] { return random.uniform(-12e-3, 12e-3); };  // also beside the grid
    const Vector3d tip(along(), along(), along());
    const Quaterniond turn = random_turn(random);
    const Brute brute = brute_force(drill.burr(), bone, tip, turn);
    const Contact c = drill.touch(bone, tip, turn);
    EXPECT_LE(std::abs(c.samples - brute.samples), brute.unsure);
    // Rounded directions are 1e-4 off, positions 4e-5.
    EXPECT_LE((c.push - brute.push).norm(), v * (brute.unsure + 2e-4 * brute.samples));
    EXPECT_LE((c.turn - brute.turn).norm(), v * r * (brute.unsure + 2e-4 * brute.samples));
  }
}

TEST(DrillTest, SameBitsOnEveryInstructionSet) {
  const auto parameters = default_burr(BurrKind::kCutting, 6.5e-3);
  std::vector<std::pair<Drill, BoneVolume>> all;
  for (const InstructionSet set : available_instruction_sets()) {
    all.emplace_back(Drill(parameters, {}, set), BoneVolume(sponge(4)));
  }
  RandomStream random(4, "poses");
  for (int n = 0; n < 100; ++n) {
    const Vector3d tip(random.uniform(-10e-3, 10e-3), random.uniform(-10e-3, 10e-3),
                       random.uniform(-10e-3, 10e-3));
    const Quaterniond turn = random_turn(random);
    std::vector<Contact> contacts;
    std::vector<double> removed;
    for (auto& [drill, bone] : all) {
      drill.begin_tick();
      contacts.push_back(drill.touch(bone, tip, turn));
      removed.push_back(drill.remove(bone, contacts.back(), 2.0, 1.0, 1e-2).amount);
      expect_same(contacts.back(), contacts.front());
      EXPECT_EQ(removed.back(), removed.front());
    }
  }
  for (const auto& [drill, bone] : all) {
    for (std::int32_t at = 0; at < bone.bricks() * BoneVolume::kBrickVoxels; ++at) {
      ASSERT_EQ(std::bit_cast<std::uint32_t>(bone.density(at)),
                std::bit_cast<std::uint32_t>(all.front().second.density(at)));
    }
  }
}

TEST(DrillTest, BordersOfBricksAreNotFelt) {
  // The same ball of bone, moved by whole voxels together with the burr.
  Drill drill(default_burr(BurrKind::kDiamond, 4e-3), {});
  RandomStream random(5, "shifts");
  const Quaterniond turn = random_turn(random);
  const auto contact = [&](const Vector3d& shift) {
    const Vector3d centre = shift * kSpacing;
    const BoneVolume bone(test::solid_bone(
        64, kSpacing, [&](const Vector3d& p) { return (p - centre).squaredNorm() < 9e-6; }));
    drill.begin_tick();
    Contact c = drill.touch(bone, centre + kSpacing * Vector3d(1.25, -2.5, 6.0), turn);
    c.centroid -= centre;
    return c;
  };
  const Contact first = contact(Vector3d::Zero());
  ASSERT_GT(first.samples, 100);
  for (int n = 0; n < 8; ++n) {
    const auto whole = [&] { return static_cast<double>(random.below(23)) - 11.0; };
    const Contact moved = contact(Vector3d(whole(), whole(), whole()));
    EXPECT_EQ(moved.samples, first.samples);
    EXPECT_EQ(moved.push, first.push);
    EXPECT_EQ(moved.turn, first.turn);
    EXPECT_NEAR((moved.centroid - first.centroid).norm(), 0.0, 1e-12);
  }
}

TEST(DrillTest, AQuarterTurnOfEverythingTurnsTheContact) {
  const auto inside = [](const Vector3d& p) { return p.z() + 0.3 * p.x() - 0.2 * p.y() < 1e-4; };
  const Quaterniond quarter(Eigen::AngleAxisd(0.5 * std::numbers::pi, Vector3d::UnitX()));
  const BoneVolume bone(test::solid_bone(40, kSpacing, inside));
  const BoneVolume turned(test::solid_bone(
      40, kSpacing, [&](const Vector3d& p) { return inside(quarter.conjugate() * p); }));
  Drill drill(default_burr(BurrKind::kDiamond, 5e-3), {});
  RandomStream random(6, "turns");
  for (int n = 0; n < 20; ++n) {
    drill.begin_tick();
    const Vector3d tip(random.uniform(-2e-3, 2e-3), random.uniform(-2e-3, 2e-3), 1.5e-3);
    const Quaterniond turn = random_turn(random);
    const Contact a = drill.touch(bone, tip, turn);
    const Contact b = drill.touch(turned, quarter * tip, quarter * turn);
    EXPECT_NEAR(a.samples, b.samples, 3 + 2e-3 * a.samples);
    EXPECT_NEAR((quarter * a.push - b.push).norm(), 0.0, 4e-3 * a.volume);
    EXPECT_NEAR((quarter * a.turn - b.turn).norm(), 0.0, 4e-3 * a.volume * drill.burr().radius());
  }
}

TEST(DrillTest, ResultsHardlyDependOnTheSampling) {
  const BoneVolume bone(test::flat_bone(40, kSpacing));
  const FeelParameters feel = default_feel(2e-3);
  BurrParameters fine = default_burr(BurrKind::kDiamond, 4e-3);
  BurrParameters coarse = fine;
  coarse.sample_spacing *= 2.0;
  Drill a(fine, {});
  Drill b(coarse, {});
  for (const double d : {0.4e-3, 0.8e-3, 1.6e-3}) {
    const Vector3d tip(1e-4, 2e-4, 2e-3 - d);
    const double force = push_force(a.touch(bone, tip, Quaterniond::Identity()), feel).norm();
    EXPECT_NEAR(push_force(b.touch(bone, tip, Quaterniond::Identity()), feel).norm(), force,
                0.05 * force + 0.02);
  }
}

TEST(DrillTest, AWhollyImmersedBurrDoesNotKnowTheWayOut) {
  const BoneVolume bone(test::solid_bone(40, kSpacing, [](const Vector3d&) { return true; }));
  Drill drill(default_burr(BurrKind::kDiamond, 4e-3), {});
  const Contact c = drill.touch(bone, Vector3d(1e-4, 2e-4, 3e-4), Quaterniond(0.3, 0.4, 0.5, 0.6));
  EXPECT_EQ(c.samples, drill.burr().samples());
  EXPECT_EQ(c.push, Vector3d(0, 0, 0));
  EXPECT_EQ(c.turn, Vector3d(0, 0, 0));
  EXPECT_EQ(push_force(c, default_feel(2e-3)), Vector3d(0, 0, 0));
}

TEST(DrillTest, TeethPullAcrossTheAxisAndAlongTheBone) {
  const BoneVolume bone(test::flat_bone(40, kSpacing));
  BurrParameters burr = default_burr(BurrKind::kCutting, 4e-3);
  burr.clockwise = false;  // as the source has the sign
  Drill drill(burr, {});
  // The handle lies along x, the bone below: (p - sc) points down, times d it points along -y.
  const Quaterniond lying(Eigen::AngleAxisd(0.5 * std::numbers::pi, Vector3d::UnitY()));
  const Contact c = drill.touch(bone, Vector3d(0, 0, 1.6e-3), lying);
  const Vector3d expected = (-Vector3d::UnitZ()).cross(Vector3d::UnitX());
  const Vector3d drag = drag_force(c, burr, 1.0);
  EXPECT_GT(drag.normalized().dot(expected), std::cos(0.05));
  RandomStream random(7, "turns");
  for (int n = 0; n < 20; ++n) {
    drill.begin_tick();
    const Quaterniond turn = random_turn(random);
    const Contact any = drill.touch(bone, Vector3d(0, 0, 1.6e-3), turn);
    EXPECT_NEAR(any.turn.dot(turn * Vector3d::UnitZ()), 0.0, 1e-9 * any.turn.norm());
  }
}

TEST(DrillTest, OutOfTheGridThereIsNothing) {
  const BoneVolume bone(test::solid_bone(20, kSpacing, [](const Vector3d&) { return true; }));
  Drill drill(default_burr(BurrKind::kDiamond, 4e-3), {});
  for (const double far : {20e-3, 1.0, 1e9, 1e300}) {
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_FALSE(drill.touch(bone, far * Vector3d::Unit(axis), Quaterniond::Identity()));
      EXPECT_FALSE(drill.touch(bone, -far * Vector3d::Unit(axis), Quaterniond::Identity()));
    }
  }
  // Half in, half out: half of the samples.
  const Contact half = drill.touch(bone, Vector3d(10 * kSpacing, 0, 0), Quaterniond::Identity());
  EXPECT_NEAR(half.samples, 0.5 * drill.burr().samples(), 0.01 * drill.burr().samples());
}

TEST(DrillTest, APoseThatIsNoneTouchesNothing) {
  BoneVolume bone(test::solid_bone(20, kSpacing, [](const Vector3d&) { return true; }));
  Drill drill(default_burr(BurrKind::kDiamond, 4e-3), {});
  const double inf = std::numeric_limits<double>::infinity();
  for (const double bad : {inf, -inf, std::nan("")}) {
    EXPECT_FALSE(drill.touch(bone, Vector3d(0, bad, 0), Quaterniond::Identity()));
    EXPECT_FALSE(drill.touch(bone, Vector3d::Zero(), Quaterniond(1, 0, bad, 0)));
  }
  EXPECT_FALSE(drill.touch(bone, Vector3d::Zero(), Quaterniond(0, 0, 0, 0)));
  EXPECT_FALSE(drill.touch(bone, Vector3d::Zero(), Quaterniond(1e200, 0, 0, 0)));
  // One that is only not of unit length is scaled.
  EXPECT_TRUE(drill.touch(bone, Vector3d::Zero(), Quaterniond(3, 0, 0, 0)));
}

TEST(DrillTest, TickDoesNotAllocate) {
  BoneVolume bone(sponge(8));
  Drill drill(default_burr(BurrKind::kCutting, 6e-3), {});
  const FeelParameters feel = default_feel(3e-3);
  Vector3d sum = Vector3d::Zero();
  const test::AllocationGuard guard;
  for (int n = 0; n < 20; ++n) {
    drill.begin_tick();
    const Contact c = drill.touch(bone, Vector3d(0, 0, 1e-4 * n), Quaterniond::Identity());
    const Vector3d force = bone_force(c, feel, drill.burr().parameters(), 1.0);
    drill.remove(bone, c, force.norm(), 1.0, 1e-3);
    sum += force;
  }
  EXPECT_EQ(guard.count(), 0U);
  EXPECT_TRUE(sum.allFinite());
}

TEST(DrillTest, ContactsOfSeveralBonesAddUp) {
  // Two halves of a bone, each seen from its own frame, are felt as the whole.
  const BoneVolume whole(test::flat_bone(40, kSpacing));
  const BoneVolume left(
      test::solid_bone(40, kSpacing, [](const Vector3d& p) { return p.z() < 0.0 && p.x() < 0.0; }));
  const BoneVolume right(
      test::solid_bone(40, kSpacing, [](const Vector3d& p) { return p.z() < 0.0 && p.x() > 0.0; }));
  Drill drill(default_burr(BurrKind::kDiamond, 4e-3), {});
  const Vector3d tip_W(0, 1e-4, 1e-3);
  Eigen::Isometry3d X_WB = Eigen::Isometry3d::Identity();
  X_WB.translate(Vector3d(0.1, 0.2, 0.3)).rotate(Eigen::AngleAxisd(1.0, Vector3d::UnitY()));
  const Eigen::Isometry3d X_BW = X_WB.inverse();
  const Quaterniond turn(0.8, 0.6, 0, 0);
  const Contact all = in_world(drill.touch(whole, tip_W, turn), X_WB);
  const Contact a = in_world(drill.touch(left, tip_W, turn), X_WB);
  const Contact b = in_world(drill.touch(right, tip_W, turn), X_WB);
  const Contact sum = together(a, b);
  EXPECT_EQ(sum.samples, all.samples);
  EXPECT_NEAR((sum.push - all.push).norm(), 0.0, 1e-12 * all.volume);
  EXPECT_NEAR((sum.turn - all.turn).norm(), 0.0, 1e-12 * all.volume);
  EXPECT_NEAR((sum.centroid - all.centroid).norm(), 0.0, 1e-12);
  // Back in the bone the push is up again.
  EXPECT_GT((X_BW.linear() * sum.push).normalized().z(), 0.99);
}

}  // namespace
}  // namespace haptrial::bone::drill_test
