// Drilling on the servo thread: nothing allocates, everything is logged, and the same results come
// from simulating the log again.

#include "protocols/bone_drilling/drilling_pass.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <span>
#include <tuple>

#include "core/base/random.h"
#include "core/record/table/schema.h"
#include "protocols/bone_drilling/replay_difference.h"
#include "protocols/interface/session_task.h"
#include "tests/protocols/drilling_fixture.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/scripted_device.h"

namespace haptrial::protocols {
namespace {

using Eigen::Vector3d;
using test::at;
using test::Workshop;
constexpr double kDt = 1e-3;

template <class Row>
std::vector<Row> rows_of(realtime::BlockLog<Row>& log) {
  std::vector<Row> all;
  log.flush([&](auto rows) { all.insert(all.end(), rows.begin(), rows.end()); });
  return all;
}

int filled(const bone::Simulator& simulator) {
  int count = 0;
  for (int piece = 0; piece < simulator.world().pieces(); ++piece) {
    const bone::BoneVolume& volume = simulator.world().volume(piece);
    for (int address = 512; address < volume.bricks() * 512; ++address) {
      count += volume.density(address) > 0.0F ? 1 : 0;
    }
  }
  return count;
}

TEST(DrillingPassTest, ATickDoesNotAllocateBesideThreads) {
  Workshop shop(test::dumbbell(), true);
  const auto readings = test::through_the_bridge(8000);
  double removed = 0.0;
  {
    const test::AllocationGuard guard;
    for (const auto& reading : readings) {
      removed += shop.tool(reading).removed;
    }
    EXPECT_EQ(guard.count(), 0u);
  }
  EXPECT_GT(removed, 10.0);
}

TEST(DrillingPassTest, HintsAllocateNothingOnTheServoThreadAndAreSeen) {
  Workshop shop(test::dumbbell(), true);
  hint::HintSetup setup;
  setup.kinds[static_cast<std::size_t>(hint::HintKind::kHidden)] = true;
  setup.fewest = 1;
  const auto model = std::make_shared<const bone::BoneModel>(shop.model);
  hint::ThreadedHints hints(nullptr);
  hints.begin(
      std::make_unique<hint::HintWatch>(setup, std::make_shared<const hint::HintMap>(setup, *model),
                                        model, test::workshop(shop.model).pose_WB, 1000.0));
  shop.pass->give(hints);
  const auto readings = test::through_the_bridge(8000);
  std::uint8_t seen = 0;
  std::size_t allocations = 0;
  for (std::size_t from = 0; from < readings.size(); from += 500) {
    {
      const test::AllocationGuard guard;
      for (std::size_t i = from; i < from + 500; ++i) {
        const auto shown = shop.pass->tick(readings[i], kDt).shown;
        seen = static_cast<std::uint8_t>(seen | shown.as<bone::DrillingView>()->hints);
      }
      allocations += guard.count();
    }
    hints.settle();  // as fast as it can, and yet nothing finds no room
  }
  EXPECT_EQ(allocations, 0u);
  EXPECT_EQ(hints.dropped(), 0u);
  hints.end_pass();
  EXPECT_GT(hints.take().size(), 0u) << "the bridge is drilled from above, through bone";
  EXPECT_EQ(seen, hint::bit(hint::HintKind::kHidden));
}

TEST(DrillingPassTest, EveryEmptiedVoxelIsLoggedOnceWithItsTick) {
  Workshop shop;
  const int before = filled(*shop.simulator);
  std::uint64_t tick = 0;
  shop.new_pass(1000);
  std::vector<double> forces;
  for (const auto& reading : test::through_the_bridge(6000)) {
    forces.push_back(shop.tool(reading).contact.norm());
    ++tick;
  }
  const auto rows = rows_of(shop.logs.removals);
  std::set<std::tuple<int, int, int>> voxels;
  for (const record::RemovalRow& row : rows) {
    EXPECT_TRUE(voxels.insert({row.voxel[0], row.voxel[1], row.voxel[2]}).second);
    EXPECT_EQ(row.label, 1);
    ASSERT_GE(row.sequence, 1000u);
    ASSERT_LT(row.sequence, 7000u);
    EXPECT_EQ(row.force, forces[row.sequence - 1000]);
  }
  ASSERT_GT(rows.size(), 20u);
  EXPECT_EQ(filled(*shop.simulator), before - static_cast<int>(rows.size()));
  EXPECT_EQ(shop.simulator->emptied_so_far(), rows.size());
}

TEST(DrillingPassTest, BoneDustAndWhatWasSuckedOffAreTheBoneOfTheStart) {
  Workshop shop;
  for (const auto& reading : test::through_the_bridge(6000)) {
    shop.pass->tick(reading, kDt);
  }
  shop.companions->settle();
  const bone::DustBalance dust = shop.companions->dust();
  const double start = 2.0 * 12 * 12 * 12 + 4 * 4;
  EXPECT_EQ(shop.simulator->amount_at_start(), start);
  const double accounted =
      shop.simulator->amount_left() + dust.lying + dust.held + dust.suctioned + dust.fallen;
  EXPECT_GT(dust.deposited, 10.0);
  EXPECT_NEAR(accounted, start, 6000 * 0x1p-20);
}

TEST(DrillingPassTest, DustThatIsOnlyCountedIsTheSameAmount) {
  for (const bool threads : {false, true}) {
    Workshop shop(test::dumbbell(), threads, false);
    for (const auto& reading : test::through_the_bridge(3000)) {
      shop.pass->tick(reading, kDt);
    }
    shop.companions->settle();
    EXPECT_GT(shop.companions->dust().lying, 10.0);
    EXPECT_NEAR(shop.companions->dust().lying,
                shop.simulator->amount_at_start() - shop.simulator->amount_left(), 1e-6);
  }
}

/// Simulates the logged ticks again, on a bone of its own.
void expect_the_same_again(Workshop& first, const std::vector<device::DeviceReading>& readings) {
  const auto splits = rows_of(first.logs.splits);
  const auto removals = rows_of(first.logs.removals);
  bone::Simulator again(first.model, test::workshop(first.model));
  const DrillingInput input(first.parameters);
  std::size_t split = 0;
  std::size_t removal = 0;
  for (std::size_t tick = 0; tick < readings.size(); ++tick) {
    const bone::SimulatorInput now = input.of(as_recorded(readings[tick]), kDt);
    if (tick == 0) {
      again.begin(now.functions);
    }
    std::vector<bone::RecordedSplit> parts;
    for (; split < splits.size() && splits[split].sequence == tick; ++split) {
      const record::SplitRow& row = splits[split];
      if (row.to < 0 || parts.empty() || parts.back().to != row.to) {
        parts.push_back({row.from, row.to, {}});
      }
      parts.back().seeds.emplace_back(row.voxel[0], row.voxel[1], row.voxel[2]);
    }
    again.tick(now, parts);
    const std::size_t begin = removal;
    while (removal < removals.size() && removals[removal].sequence == tick) {
      ++removal;
    }
    ASSERT_EQ(
        difference(tick, std::span(removals).subspan(begin, removal - begin), again.emptied()), "");
  }
  EXPECT_EQ(removal, removals.size());
  EXPECT_EQ(split, splits.size());
  EXPECT_EQ(again.checksum(), first.simulator->checksum());
  EXPECT_EQ(again.pieces(), first.simulator->pieces());
}

TEST(DrillingPassTest, ACutBridgeMakesTwoPiecesThatAReplayMakesToo) {
  Workshop shop;
  const auto readings = test::through_the_bridge(12000);
  for (const auto& reading : readings) {
    shop.pass->tick(reading, kDt);
  }
  EXPECT_GE(shop.simulator->world().pieces(), 2);
  EXPECT_TRUE(shop.simulator->world().is_born(1));
  expect_the_same_again(shop, readings);
}

TEST(DrillingPassTest, AReplayIsTheSameWhateverAThreadFoundWhen) {
  Workshop shop(test::dumbbell(), true);
  const auto readings = test::through_the_bridge(12000);
  for (const auto& reading : readings) {
    shop.pass->tick(reading, kDt);
  }
  expect_the_same_again(shop, readings);
}

TEST(DrillingPassTest, WhatIsSimulatedIsOnTheGridsOfTheFile) {
  RandomStream random(1, "readings");
  for (int i = 0; i < 1000; ++i) {
    device::DeviceReading reading = at({random.normal(), random.normal(), random.normal()});
    reading.tool.velocity = {random.normal(), random.normal(), random.normal()};
    reading.orientation =
        Eigen::Quaterniond(random.normal(), random.normal(), random.normal(), random.normal())
            .normalized();
    reading.pedal = random.uniform();
    const device::DeviceReading once = as_recorded(reading);
    EXPECT_LE((once.tool.position - reading.tool.position).cwiseAbs().maxCoeff(), 0x1p-21);
    // Value that a 32-bit column gives back.
    const auto stored = [](double value) { return static_cast<double>(static_cast<float>(value)); };
    for (int a = 0; a < 3; ++a) {
      EXPECT_EQ(stored(once.tool.position[a]), once.tool.position[a]);
      EXPECT_EQ(stored(once.tool.velocity[a]), once.tool.velocity[a]);
    }
    for (int a = 0; a < 4; ++a) {
      EXPECT_EQ(stored(once.orientation.coeffs()[a]), once.orientation.coeffs()[a]);
    }
    EXPECT_EQ(stored(once.pedal), once.pedal);
    EXPECT_EQ(as_recorded(once).orientation.coeffs(), once.orientation.coeffs());
  }
}

/// The pass runs in the task, as a session has it: a jump of the device while the burr is pressed
/// in.
TEST(DrillingPassTest, AFaultBringsTheForceToZeroAndEveryTickIsLoggedAllTheSame) {
  Workshop shop;
  test::ScriptedDevice device;
  constexpr std::size_t kFault = 1500;
  constexpr std::size_t kTicks = 2000;
  device.on_read = [&](std::size_t tick, device::DeviceReading& reading) {
    const double depth = std::min(0.006, 2e-6 * static_cast<double>(tick));
    reading = at({0.005, 0.0052 - depth, 0.0}, 1u);
    reading.tool.position.x() += tick == kFault ? 0.02 : 0.0;
    return true;
  };
  device::EnvelopeLimits limits;
  limits.ramp_in = 0.0;
  SessionTask::Log log;
  SessionTask task(device, limits, log, {}, SessionTask::Leave::kNever, &shop.logs);
  task.start(*shop.pass, 0);
  for (std::uint64_t i = 0; i < kTicks; ++i) {
    task.tick({i, static_cast<std::int64_t>(i) * 1'000'000, kDt});
  }
  EXPECT_GT(device.written[kFault - 1].norm(), 0.1);
  for (std::size_t i = kFault; i < kTicks; ++i) {
    ASSERT_EQ(device.written[i], Vector3d::Zero());
  }
  ASSERT_TRUE(task.idle());
  EXPECT_EQ(task.result().fault, device::Fault::kJump);
  EXPECT_EQ(task.result().state, PassState::kAborted);
  const auto tool = rows_of(shop.logs.tool);
  const auto samples = rows_of(log);
  ASSERT_EQ(tool.size(), kTicks);
  ASSERT_EQ(samples.size(), kTicks);
  for (std::size_t i = 0; i < kTicks; ++i) {
    ASSERT_EQ(tool[i].sequence, samples[i].sequence);
    ASSERT_EQ(tool[i].active, i < kFault);
    ASSERT_EQ(tool[i].buttons, 1u);
  }
}

/// Another tool, a view that is moved and a piece that is carried: the resting hand loses what it
/// leans on by degrees.
TEST(DrillingPassTest, WhatAHandLeansOnFadesIfItTakesAnotherToolOrMovesTheView) {
  for (const std::uint32_t button : {2u, 4u, 64u}) {
    SCOPED_TRACE(button);
    Workshop shop;
    test::ScriptedDevice device;
    constexpr std::size_t kChange = 1500;
    constexpr std::size_t kTicks = 1600;
    device.on_read = [&](std::size_t tick, device::DeviceReading& reading) {
      const double depth = std::min(0.0015, 2e-6 * static_cast<double>(tick));
      reading.tool.position += Vector3d(0.005, 0.0052 - depth, 0.0);
      reading.buttons = tick >= kChange ? button : 0u;
      return true;
    };
    device::EnvelopeLimits limits;
    limits.ramp_in = 0.0;
    SessionTask::Log log;
    SessionTask task(device, limits, log, {}, SessionTask::Leave::kNever, &shop.logs);
    task.start(*shop.pass, 0);
    for (std::uint64_t i = 0; i < kTicks; ++i) {
      task.tick({i, static_cast<std::int64_t>(i) * 1'000'000, kDt});
    }
    ASSERT_FALSE(task.idle());
    const Vector3d leant = device.written[kChange - 1];
    ASSERT_GT(leant.norm(), 0.4);
    for (std::size_t i = kChange; i < kTicks; ++i) {
      const double u =
          std::min(1.0, static_cast<double>(i + 1 - kChange) * kDt / limits.change_time);
      const double left = 1.0 - u * u * (3.0 - 2.0 * u);
      ASSERT_LT((device.written[i] - left * leant).norm(), 1e-6) << i;
    }
  }
}

TEST(DrillingPassTest, ToolsChangeByButtonAndOnlyWhenItGoesDown) {
  Workshop shop;
  const Vector3d away(0.0, 0.02, 0.0);
  EXPECT_EQ(shop.tool(at(away)).tool, 0);
  EXPECT_EQ(shop.tool(at(away, 2u)).tool, 1);
  EXPECT_EQ(shop.tool(at(away, 2u)).tool, 1);
  shop.pass->tick(at(away), kDt);
  EXPECT_EQ(shop.tool(at(away, 2u)).tool, 2);
  shop.pass->tick(at(away), kDt);
  EXPECT_EQ(shop.tool(at(away, 2u)).tool, 0);
  shop.new_pass();  // the button is still held
  EXPECT_EQ(shop.tool(at(away, 2u)).tool, 0);
}

TEST(DrillingPassTest, TheCameraMovesWithTheHandWhileItsButtonIsHeldAndNothingIsFelt) {
  Workshop shop;
  const Vector3d away(0.0, 0.02, 0.0);
  shop.pass->tick(at(away), kDt);
  const Camera start = shop.simulator->camera();
  shop.pass->tick(at(away, 4u), kDt);
  // The hand goes into the bone: while the camera is steered there is no force.
  const PassOutput out = shop.pass->tick(at({0.01, 0.0, 0.0}, 4u | 1u), kDt);
  EXPECT_EQ(out.force, Vector3d::Zero());
  EXPECT_EQ(shop.logs.tool_now().mode, 1);
  const Vector3d motion(0.01, -0.02, 0.0);
  const Vector3d expected = start.axes() * motion;
  constexpr double kGrid = 0x1p-19;  // two positions, each rounded
  EXPECT_LT((shop.simulator->camera().eye - start.eye - expected).norm(), kGrid);
  EXPECT_LT((shop.simulator->camera().target - start.target - expected).norm(), kGrid);
  // Back from the camera inside the bone: nothing before the burr has been free.
  EXPECT_EQ(shop.pass->tick(at({0.005, 0.0, 0.0}, 1u), kDt).force, Vector3d::Zero());
  EXPECT_EQ(rows_of(shop.logs.removals).size(), 0u);
  shop.pass->tick(at(away), kDt);
  EXPECT_GT(shop.pass->tick(at({0.005, 0.0042, 0.0}, 1u), kDt).force.norm(), 0.0);
  const auto camera = rows_of(shop.logs.camera);
  ASSERT_GE(camera.size(), 2u);
  EXPECT_EQ(camera.front().eye, start.eye);
  EXPECT_EQ(camera.back().eye, shop.simulator->camera().eye);
}

TEST(DrillingPassTest, TurningKeepsTheDistanceAndTheTarget) {
  Workshop shop;
  shop.pass->tick(at({0.0, 0.02, 0.0}, 8u), kDt);
  const Camera start = shop.simulator->camera();
  shop.pass->tick(at({0.01, 0.02, 0.0}, 8u), kDt);
  const Camera& now = shop.simulator->camera();
  EXPECT_EQ(now.target, start.target);
  EXPECT_NEAR((now.eye - now.target).norm(), (start.eye - start.target).norm(), 1e-12);
  // The default turns 12 rad for a metre, about the axis that is up.
  const auto flat = [](const Vector3d& v) { return Vector3d(v.x(), 0.0, v.z()).normalized(); };
  EXPECT_NEAR(std::acos(flat(now.eye).dot(flat(start.eye))), 0.12, 12.0 * 0x1p-19);
}

TEST(DrillingPassTest, EndsByButtonOrWhenTheTimeIsOver) {
  Workshop shop;
  const Vector3d away(0.0, 0.02, 0.0);
  shop.pass->tick(at(away), kDt);
  EXPECT_EQ(shop.pass->state(), PassState::kRunning);
  shop.pass->tick(at(away, 32u), kDt);
  EXPECT_EQ(shop.pass->state(), PassState::kCompleted);
  shop.parameters.time_limit = 0.1;
  shop.new_pass();
  for (int i = 0; i < 99; ++i) {
    shop.pass->tick(at(away), kDt);
    ASSERT_EQ(shop.pass->state(), PassState::kRunning);
  }
  shop.pass->tick(at(away), kDt);
  EXPECT_EQ(shop.pass->state(), PassState::kCompleted);
}

TEST(DrillingPassTest, ACutPlaneTakesAPartOffWhichIsThenCarried) {
  Workshop shop;
  const Vector3d away(0.0, 0.03, 0.0);
  shop.pass->tick(at(away), kDt);
  for (int change = 0; change < 2; ++change) {  // to the cut plane
    shop.pass->tick(at(away, 2u), kDt);
    shop.pass->tick(at(away), kDt);
  }
  // Upright, the plane's normal is W's y turned to the tool's z; lay it across x.
  device::DeviceReading across = at(Vector3d::Zero(), 16u);
  across.orientation = Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitY(), Vector3d::UnitX());
  shop.pass->tick(across, kDt);
  for (int i = 0; i < 2000; ++i) {
    shop.pass->tick(at(away), kDt);
  }
  ASSERT_EQ(shop.simulator->world().pieces(), 2);
  EXPECT_GT(shop.simulator->cut_so_far(), 3.0);
  EXPECT_NEAR(shop.simulator->amount_left() + shop.simulator->cut_so_far(),
              shop.simulator->amount_at_start(), 1e-6);
  const Eigen::Isometry3d before = shop.simulator->world().pose(1);
  const Vector3d grip = before * shop.model.grid.centre(20, 11, 6);
  for (int i = 0; i <= 100; ++i) {
    shop.pass->tick(at(grip + 1e-4 * i * Vector3d::UnitY(), 64u), kDt);
  }
  const Vector3d way = shop.simulator->world().pose(1).translation() - before.translation();
  const Vector3d other = shop.simulator->world().pose(0).translation() - before.translation();
  const bool second_moved = (way - 0.01 * Vector3d::UnitY()).norm() < 1e-4;
  const bool first_moved = (other - 0.01 * Vector3d::UnitY()).norm() < 1e-4;
  EXPECT_NE(second_moved, first_moved) << "one of the two is carried, the other stays";
}

}  // namespace
}  // namespace haptrial::protocols
