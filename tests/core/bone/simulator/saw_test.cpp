// A saw against the geometry of its slot, and what it must not do.

#include "core/bone/simulator/saw.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/bone/simulator/simulator.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/solid_bone.h"

namespace haptrial::bone::saw_test {
namespace {

using Eigen::Vector3d;
constexpr double kEdge = 0.5e-3;
constexpr double kTeeth = 0.5e-3;  // from the middle of the teeth to their points

/// Bone of z < 0.
BoneModel floor_of_bone() {
  return test::solid_bone(64, kEdge, [](const Vector3d& p) { return p.z() < 0.0; });
}

SimulatorParameters with_saw() {
  SimulatorParameters p;
  p.tools = {{"saw", 2.5e-3, 0.1, saw_tool({})}};
  p.heat.emplace();
  return p;
}

/// A saw whose blade stands upright, its width along x.
SimulatorInput upright(const Vector3d& tip, double power) {
  SimulatorInput input;
  input.tool.tip.position = tip;
  input.power = power;
  return input;
}

/// Presses down with a given force: the tip goes to where bone bears it. @returns its height [m]
double press_down(Simulator& saw, double force, int ticks, double power) {
  double z = kTeeth + 1e-3;
  for (int tick = 0; tick < ticks; ++tick) {
    const double against =
        saw.tick(upright({0.0, 0.0, z}, power)).force.z() + saw.output().shaft.z();
    z += 2e-5 * std::tanh((against - force) / force);
  }
  return z;
}

TEST(SawTest, ASlotIsAsWideAsTheBladeToTheVoxel) {
  const BoneModel model = floor_of_bone();
  Simulator saw(model, with_saw());
  const double z = press_down(saw, 4.0, 1500, 1.0);
  EXPECT_LT(z, -6e-3);
  const SawParameters blade;
  const BoneVolume& volume = saw.world().volume(0);
  int inside = 0;
  for (std::int32_t address = 512; address < volume.bricks() * 512; ++address) {
    const Voxel voxel = volume.voxel_at(address);
    if (model.labels[model.grid.index(voxel)] == 0) {
      continue;
    }
    const Vector3d p = model.grid.centre(voxel);
    const bool deep = p.z() < z - kTeeth - 0.5 * kEdge - 1e-5;
    const bool beyond = std::abs(p.x()) > 0.5 * (blade.width + kEdge) + 1e-5 ||
                        std::abs(p.y()) > 0.5 * (blade.kerf + kEdge) + 1e-5;
    const bool within = std::abs(p.x()) < 0.5 * blade.width - kEdge &&
                        std::abs(p.y()) < 0.5 * blade.kerf && p.z() > z + 1e-3;
    if (deep || beyond) {
      EXPECT_EQ(volume.density(address), 1.0F) << voxel.transpose();
    }
    inside += within ? 1 : 0;
    if (within) {
      EXPECT_EQ(volume.density(address), 0.0F) << voxel.transpose();
    }
  }
  EXPECT_GT(inside, 100);
}

TEST(SawTest, LeaningOnTheBladeCutsNothingAndIsPushedBack) {
  Simulator saw(floor_of_bone(), with_saw());
  const double z = press_down(saw, 4.0, 1200, 1.0);
  const double before = saw.removed_so_far();
  double most = 0.0;
  for (int tick = 0; tick < 400; ++tick) {  // up a little, then sideways into the wall
    const double y = std::min(1e-3, 5e-6 * tick);
    const SimulatorOutput& out = saw.tick(upright({0.0, y, z + 1.5e-3}, 1.0));
    most = std::max(most, -(out.force + out.shaft).y());
  }
  EXPECT_LT(saw.removed_so_far() - before, 1.0);  // crumbs in the slot [voxels]
  EXPECT_GT(most, 2.0);
}

TEST(SawTest, NobodyAsksForAForceInAStraightSlot) {
  Simulator saw(floor_of_bone(), with_saw());
  const double z = press_down(saw, 4.0, 1200, 1.0);
  for (int tick = 0; tick < 200; ++tick) {
    const double up = z + 0.5e-3 + 2e-5 * tick;
    const SimulatorOutput& out = saw.tick(upright({0.0, 0.0, up}, tick % 2 == 0 ? 1.0 : 0.0));
    EXPECT_EQ((out.force + out.shaft).norm(), 0.0);
  }
}

TEST(SawTest, AClosedPathAgainstFlatBoneGivesNoEnergy) {
  Simulator saw(floor_of_bone(), with_saw());
  saw.tick(upright({0.0, 0.0, 5e-3}, 0.0));
  double work = 0.0;   // of bone on the hand [J]
  double spent = 0.0;  // by the hand on the way in [J]
  constexpr int kSteps = 4000;
  Vector3d last(0.0, 0.0, kTeeth + 1e-4);
  for (int n = 0; n <= kSteps; ++n) {
    const double angle = 2.0 * std::numbers::pi * n / kSteps;
    const Vector3d tip(1e-3 * std::sin(angle), 4e-4 * std::sin(2.0 * angle),
                       kTeeth + 1e-4 - 2e-4 * (1.0 - std::cos(angle)));
    const double part = saw.tick(upright(tip, 0.0)).force.dot(tip - last);
    work += part;
    spent += std::max(0.0, -part);
    last = tip;
  }
  EXPECT_GT(spent, 2e-4);
  EXPECT_LT(std::abs(work), 0.05 * spent);
}

TEST(SawTest, SawingWarmsUpAndHoldingStillDoesNot) {
  Simulator still(floor_of_bone(), with_saw());
  press_down(still, 4.0, 500, 0.0);
  Simulator saws(floor_of_bone(), with_saw());
  press_down(saws, 4.0, 500, 1.0);
  EXPECT_EQ(still.heat()->hottest(), HeatParameters{}.body);
  EXPECT_GT(saws.heat()->hottest(), HeatParameters{}.body + 0.1);
}

TEST(SawTest, ATickDoesNotAllocate) {
  Simulator saw(floor_of_bone(), with_saw());
  test::AllocationGuard guard;
  press_down(saw, 4.0, 300, 1.0);
  EXPECT_EQ(guard.count(), 0U);
}

}  // namespace
}  // namespace haptrial::bone::saw_test
