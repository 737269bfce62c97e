#pragma once

#include <memory>
#include <vector>

#include "core/bone/simulator/companions.h"
#include "core/bone/simulator/simulator.h"
#include "protocols/bone_drilling/drilling_pass.h"

namespace haptrial::test {

/// Two blocks of bone, 12 x 12 x 12 voxels of 0.5 mm each, joined by a bridge along x: 4 voxels
/// long, 2 x 2 wide. Voxels with i < 12 are block one, those above 15 block two.
bone::BoneModel dumbbell();

/// A burr, a suction and a cut plane around a bone whose middle lies at the origin of W, with
/// device buttons 0 power, 1 next tool, 2 camera move, 3 camera turn, 4 apply, 5 finish, 6 carry.
bone::SimulatorParameters workshop(const bone::BoneModel& model);
protocols::DrillingParameters by_buttons();

/// All that a drilling needs but a device.
struct Workshop {
  explicit Workshop(bone::BoneModel bone = dumbbell(), bool threads = false, bool dusty = true);

  bone::BoneModel model;
  std::unique_ptr<bone::Simulator> simulator;
  std::unique_ptr<bone::Companions> companions;
  protocols::DrillingLogs logs;
  protocols::DrillingParameters parameters{by_buttons()};
  std::unique_ptr<protocols::DrillingPass> pass;

  void new_pass(std::uint64_t sequence = 0);
  /// One tick of a millisecond. @returns what it says of the tool
  record::ToolRow tool(const device::DeviceReading& reading) {
    pass->tick(reading, 1e-3);
    return logs.tool_now();
  }
};

/// A tool at p with buttons held, upright.
device::DeviceReading at(const Eigen::Vector3d& p, std::uint32_t buttons = 0);

/// A path of the tip that presses a burr through the bridge of the dumbbell, one reading a tick,
/// with the burr on.
std::vector<device::DeviceReading> through_the_bridge(int ticks);

}  // namespace haptrial::test
