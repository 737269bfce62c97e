// A cut through a bone as large as a real one leaves a row for every voxel, whatever the clock.

#include <gtest/gtest.h>

#include <chrono>
#include <set>
#include <thread>

#include "core/bone/record/drilling_tables.h"
#include "core/realtime/servo_loop.h"
#include "core/record/hdf5/session_writer.h"
#include "core/record/read/session_reader.h"
#include "protocols/bone_drilling/drilling_pass.h"
#include "protocols/interface/session_task.h"
#include "tests/protocols/drilling_fixture.h"
#include "tests/support/scripted_device.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::protocols {
namespace {

using realtime::ClockKind;

/// The grid of a scanned temporal bone, 171 x 171 x 169 voxels of 0.288 mm, as a full block: 2.7
/// times the bone's voxels.
bone::BoneModel large_block() {
  bone::BoneModel model;
  model.name = "block";
  model.source = "made by a test";
  model.grid = {{171, 171, 169}, {0.0, 0.0, 0.0}, 0.288e-3};
  model.labels.assign(model.grid.count(), 1);
  model.structures = {{}, {"bone", {0.9, 0.8, 0.7}, 1.0, false}};
  return model;
}

class CutLogTest : public testing::TestWithParam<ClockKind> {};

TEST_P(CutLogTest, EveryVoxelOfAFullCutIsInTheFile) {
  const test::TemporaryFolder folder;
  const bone::BoneModel model = large_block();
  bone::SimulatorParameters parameters = test::workshop(model);
  parameters.tools = {parameters.tools[2]};
  auto& plane = std::get<bone::CutPlane>(parameters.tools[0].kind);
  plane.width = plane.height = 0.085;
  plane.depth = 1e-3;
  bone::Simulator simulator(model, parameters);
  bone::CompanionParameters beside;
  beside.dusty = false;
  bone::SteppedCompanions companions(simulator, beside, 1000.0, false);
  DrillingParameters drilling = test::by_buttons();
  drilling.time_limit = 1.2;
  DrillingLogs logs;
  DrillingPass pass(simulator, companions, drilling, logs, 1000.0);

  test::ScriptedDevice device;
  device.on_read = [](std::size_t tick, device::DeviceReading& reading) {
    reading = test::at(Eigen::Vector3d::Zero(), tick >= 20 && tick < 40 ? 16u : 0u);
    return true;
  };
  device::EnvelopeLimits limits;
  SessionTask::Log log;
  const bool real = GetParam() == ClockKind::kReal;
  SessionTask task(device, limits, log, {},
                   real ? SessionTask::Leave::kNever : SessionTask::Leave::kAfterPassOrSlice,
                   &logs);
  realtime::ServoLoop loop(GetParam(), 1000.0);

  record::SessionInfo info;
  info.clock = real ? "real" : "simulated";
  info.rate = 1000.0;
  record::SessionWriter writer(folder / "cut.h5", info, record::drilling_tables());
  const auto collect = [&] {
    logs.tool.flush([&](auto rows) { writer.add(rows); });
    logs.removals.flush([&](auto rows) { writer.add(rows); });
    log.flush([&](auto rows) { writer.append(rows); });
  };
  task.start(pass, 0);
  std::thread servo;
  if (real) {
    servo = std::thread([&] { loop.run(task); });
  }
  while (!task.idle()) {
    real ? std::this_thread::sleep_for(std::chrono::milliseconds(5)) : loop.run(task);
    collect();
  }
  if (real) {
    loop.request_stop();
    servo.join();
  }
  collect();
  writer.close();

  EXPECT_EQ(logs.removals.dropped() + logs.splits.dropped() + log.dropped() + logs.tool.dropped(),
            0u);
  const record::SessionReader reader(folder / "cut.h5");
  std::set<std::array<std::int32_t, 3>> gone;
  for (const record::RemovalRow& row : reader.rows<record::RemovalRow>()) {
    EXPECT_EQ(row.force, 0.0);
    EXPECT_EQ(row.label, 1);
    ASSERT_TRUE(gone.insert(row.voxel).second) << "told twice";
  }
  // Upright, the tool's z is W's y: the cut reaches 3.47 voxels from the middle of layer j = 85.
  std::size_t missing = 0;
  for (int k = 0; k < 169; ++k) {
    for (int j = 0; j < 171; ++j) {
      for (int i = 0; i < 171; ++i) {
        missing += simulator.world().holder({i, j, k}) < 0 ? 1 : 0;
      }
    }
  }
  EXPECT_EQ(gone.size(), missing);
  EXPECT_EQ(missing, 171u * 169u * 4u);
  double removed = 0.0;
  for (const record::ToolRow& row : reader.rows<record::ToolRow>()) {
    removed += row.removed;
  }
  EXPECT_EQ(removed, simulator.cut_so_far());
  EXPECT_EQ(simulator.emptied_so_far(), missing);
}

INSTANTIATE_TEST_SUITE_P(Clocks, CutLogTest,
                         testing::Values(ClockKind::kSimulated, ClockKind::kReal));

}  // namespace
}  // namespace haptrial::protocols
