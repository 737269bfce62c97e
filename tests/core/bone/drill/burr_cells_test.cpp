// Burrs whose samples lie in a tree of cells, as in bone of fine voxels.

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <set>

#include "core/base/random.h"
#include "core/bone/drill/drill.h"
#include "core/bone/drill/feel.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/solid_bone.h"

namespace haptrial::bone::burr_cells_test {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double kFine = 1.0 / 8192;  // about 0.12 mm, and exact in doubles

Quaterniond random_turn(RandomStream& random) {
  return Quaterniond(random.normal(), random.normal(), random.normal(), random.normal())
      .normalized();
}

/// Flat bone with air cells as wide as the cells of a burr, and fine holes on one side.
BoneModel honeycomb(std::uint64_t seed) {
  RandomStream random(seed, "honeycomb");
  return test::solid_bone(80, kFine, [&](const Vector3d& p) {
    const bool wall =
        std::sin(p.x() / 4e-4) + std::sin(p.y() / 5e-4) + std::sin(p.z() / 3e-4) < 1.2;
    return p.z() < 2e-3 && wall && (p.x() < 2e-3 || random.below(4) != 0);
  });
}

BurrParameters fine_burr(double diameter = 4.2e-3) {
  return for_bone(default_burr(BurrKind::kCutting, diameter), kFine);
}

TEST(BurrCellsTest, SamplesFollowTheBoneUnlessTheyAreTold) {
  BurrParameters burr = default_burr(BurrKind::kCutting, 6e-3);
  EXPECT_EQ(for_bone(burr, 0.5e-3).sample_spacing, burr.sample_spacing);
  EXPECT_EQ(for_bone(burr, 0.19e-3).sample_spacing, 0.46 * 0.19e-3);
  EXPECT_GT(for_bone(burr, 0.02e-3).sample_spacing, 0.01e-3) << "there are too many";
  EXPECT_NEAR(Burr(for_bone(burr, 0.02e-3)).samples(), 400'000, 4000);
  burr.follows_bone = false;
  EXPECT_EQ(for_bone(burr, 0.19e-3).sample_spacing, burr.sample_spacing);
  EXPECT_TRUE(Burr(default_burr(BurrKind::kDiamond, 7e-3)).cells().empty());
}

TEST(BurrCellsTest, EverySampleIsInOneLeafAndEveryCellKnowsItsSums) {
  const Burr burr(fine_burr());
  const Burr::Arrays samples = burr.arrays();
  std::int32_t next = 0;
  for (std::size_t c = 0; c < burr.cells().size(); ++c) {
    const Burr::Cell& cell = burr.cells()[c];
    if (cell.leaf) {
      EXPECT_EQ(cell.first, next);
      next = cell.first + cell.count;
      EXPECT_EQ(cell.after, static_cast<std::int32_t>(c) + 1);
    }
    std::array<std::int32_t, 3> direction{};
    std::array<std::int32_t, 3> position{};
    for (std::int32_t s = cell.first; s < cell.first + cell.count; ++s) {
      const std::array place{samples.x[s], samples.y[s], samples.z[s]};
      const std::array towards{samples.dx[s], samples.dy[s], samples.dz[s]};
      for (std::size_t axis = 0; axis < 3; ++axis) {
        ASSERT_LE(std::abs(place[axis] - cell.centre[axis]), cell.half);
        direction[axis] += towards[axis];
        position[axis] += place[axis];
      }
    }
    ASSERT_EQ(direction, cell.direction);
    ASSERT_EQ(position, cell.position);
  }
  EXPECT_EQ(next, burr.samples());
}

TEST(BurrCellsTest, WholeCellsAreWhatTheirSamplesAre) {
  const BoneVolume bone(honeycomb(1));
  Drill drill(fine_burr(), {});
  const Burr& burr = drill.burr();
  ASSERT_FALSE(burr.cells().empty());
  RandomStream random(1, "poses");
  int whole = 0;
  for (int n = 0; n < 40; ++n) {
    drill.begin_tick();
    const auto along = [&] { return random.uniform(-6e-3, 6e-3); };  // also beside the grid
    const Vector3d tip(along(), along(), along());
    const Quaterniond turn = random_turn(random);
    const Contact c = drill.touch(bone, tip, turn);
    int samples = 0;
    int unsure = 0;
    Vector3d push = Vector3d::Zero();
    for (std::int32_t s = 0; s < burr.samples(); ++s) {
      const Vector3d p = turn * burr.position(s);
      const Eigen::Array3d at = ((tip + p - bone.grid().origin) / kFine).array() + 0.5;
      unsure += ((at - at.round()).abs() < 2e-3).any();
      if (bone.density(Voxel(at.floor().cast<int>().matrix())) > 0.0F) {
        ++samples;
        push -= burr.sample_volume() * p.normalized();
      }
    }
    EXPECT_LE(std::abs(c.samples - samples), unsure);
    EXPECT_LE((c.push - push).norm(), burr.sample_volume() * (unsure + 2e-4 * samples));
    whole += c.cells;
  }
  EXPECT_GT(whole, 1000);
}

TEST(BurrCellsTest, SameBitsOnEveryInstructionSet) {
  std::vector<std::pair<Drill, BoneVolume>> all;
  for (const InstructionSet set : available_instruction_sets()) {
    all.emplace_back(Drill(fine_burr(), {}, set), BoneVolume(honeycomb(2)));
  }
  RandomStream random(2, "poses");
  for (int n = 0; n < 60; ++n) {
    const Vector3d tip(random.uniform(-4e-3, 4e-3), random.uniform(-4e-3, 4e-3),
                       random.uniform(-4e-3, 4e-3));
    const Quaterniond turn = random_turn(random);
    Contact first;
    double removed = 0.0;
    for (auto& [drill, bone] : all) {
      drill.begin_tick();
      const Contact c = drill.touch(bone, tip, turn);
      const double amount = drill.remove(bone, c, 2.0, 1.0, 1e-3).amount;
      const bool is_first = &drill == &all.front().first;
      first = is_first ? c : first;
      removed = is_first ? amount : removed;
      EXPECT_EQ(c.samples, first.samples);
      EXPECT_EQ(c.push, first.push);
      EXPECT_EQ(c.turn, first.turn);
      EXPECT_EQ(amount, removed);
    }
  }
  for (const auto& [drill, bone] : all) {
    for (std::int32_t at = 0; at < bone.bricks() * BoneVolume::kBrickVoxels; ++at) {
      ASSERT_EQ(std::bit_cast<std::uint32_t>(bone.density(at)),
                std::bit_cast<std::uint32_t>(all.front().second.density(at)));
    }
  }
}

/// Deep in bone samples take turns; in the mean they take what they all take.
TEST(BurrCellsTest, SamplesThatTakeTurnsRemoveAsMuch) {
  const BurrParameters parameters = fine_burr();
  Drill drill(parameters, {});
  const Burr& burr = drill.burr();
  ASSERT_GT(burr.samples(), 2 * Drill::kMostTaking);
  BoneVolume bone(test::solid_bone(60, kFine, [](const Vector3d&) { return true; }));
  double each = 0.0;  // all samples, 1/(N·s) times their volume
  for (std::int32_t s = 0; s < burr.samples(); ++s) {
    each += static_cast<double>(burr.power(s)) * burr.sample_volume();
  }
  constexpr int kTicks = 60;
  constexpr double kForce = 0.1;
  double volume = 0.0;
  for (int n = 0; n < kTicks; ++n) {
    drill.begin_tick();
    const Contact c = drill.touch(bone, Vector3d::Zero(), Quaterniond::Identity());
    ASSERT_EQ(c.samples, burr.samples());
    volume += drill.remove(bone, c, kForce, 1.0, 1e-3).volume;
  }
  EXPECT_NEAR(volume, kForce * kTicks * 1e-3 * each, 0.01 * volume);
}

/// Bone that is felt is drilled, and the other way round: a burr that plunges leaves no voxel
/// behind.
TEST(BurrCellsTest, APlungeLeavesNoCrumbs) {
  BoneVolume bone(test::flat_bone(80, kFine));
  BurrParameters parameters = fine_burr(3e-3);
  parameters.removal_rate = 5000.0;
  Drill drill(parameters, {});
  constexpr double kDepth = 2e-3;
  const double r = drill.burr().radius();
  for (int n = 0; n <= 60; ++n) {
    drill.begin_tick();
    const Vector3d tip(1e-5, 2e-5, r - kDepth * std::min(1.0, n / 50.0));
    const Contact c = drill.touch(bone, tip, Quaterniond::Identity());
    drill.remove(bone, c, 5.0, 1.0, 1e-3);
  }
  const geometry::VoxelGrid& grid = bone.grid();
  int left = 0;
  int inside = 0;
  for (std::int32_t at = BoneVolume::kBrickVoxels; at < bone.bricks() * BoneVolume::kBrickVoxels;
       ++at) {
    const Voxel v = bone.voxel_at(at);
    const double from = (grid.centre(v) - Vector3d(1e-5, 2e-5, r - kDepth)).norm();
    if (grid.centre(v).z() < 0.0 && from < r - std::sqrt(3.0) * kFine) {
      ++inside;
      left += bone.density(at) > 0.0F ? 1 : 0;
    }
  }
  EXPECT_GT(inside, 1000);
  EXPECT_EQ(left, 0);
}

TEST(BurrCellsTest, TickDoesNotAllocate) {
  BoneVolume bone(honeycomb(3));
  Drill drill(fine_burr(), {});
  Vector3d sum = Vector3d::Zero();
  const test::AllocationGuard guard;
  for (int n = 0; n < 20; ++n) {
    drill.begin_tick();
    const Contact c = drill.touch(bone, Vector3d(0, 0, 1e-4 * n), Quaterniond::Identity());
    drill.remove(bone, c, 2.0, 1.0, 1e-3);
    sum += c.push;
  }
  EXPECT_EQ(guard.count(), 0U);
  EXPECT_TRUE(sum.allFinite());
}

}  // namespace
}  // namespace haptrial::bone::burr_cells_test
