#include "tests/protocols/drilling_fixture.h"

#include <cmath>
#include <numbers>

namespace haptrial::test {

bone::BoneModel dumbbell() {
  bone::BoneModel model;
  model.name = "dumbbell";
  model.source = "made by a test";
  model.grid = {{28, 12, 12}, {0.0, 0.0, 0.0}, 5e-4};
  model.labels.assign(model.grid.count(), 0);
  for (int k = 0; k < 12; ++k) {
    for (int j = 0; j < 12; ++j) {
      for (int i = 0; i < 28; ++i) {
        const bool block = i < 12 || i >= 16;
        const bool bridge = j >= 5 && j < 7 && k >= 5 && k < 7;
        model.labels[model.grid.index(i, j, k)] = block || bridge ? 1 : 0;
      }
    }
  }
  model.structures = {{}, {"bone", {0.9, 0.8, 0.7}, 1.0, false}};
  return model;
}

bone::SimulatorParameters workshop(const bone::BoneModel& model) {
  bone::SimulatorParameters p;
  bone::ToolSpec burr;
  burr.name = "burr";
  burr.kind = bone::BurrTool{bone::default_burr(bone::BurrKind::kCutting, 3e-3),
                             bone::default_feel(1.5e-3)};
  bone::ToolSpec suction;
  suction.name = "suction";
  suction.kind = bone::SuctionTool{};
  bone::ToolSpec plane;
  plane.name = "plane";
  auto& cut = plane.kind.emplace<bone::CutPlane>();
  cut.width = cut.height = 0.02;
  p.tools = {burr, suction, plane};
  const geometry::VoxelGrid& grid = model.grid;
  p.pose_WB.translation() = -0.5 * (grid.centre(0, 0, 0) + grid.centre(grid.last()));
  return p;
}

protocols::DrillingParameters by_buttons() {
  protocols::DrillingParameters p;
  using bone::Function;
  const auto press = [&](Function function, unsigned button) {
    p.controls.buttons[static_cast<std::size_t>(function)] = 1u << button;
  };
  press(Function::kPower, 0);
  press(Function::kNextTool, 1);
  press(Function::kCameraMove, 2);
  press(Function::kCameraTurn, 3);
  press(Function::kApply, 4);
  press(Function::kFinish, 5);
  press(Function::kCarry, 6);
  p.time_limit = 60.0;
  return p;
}

Workshop::Workshop(bone::BoneModel bone, bool threads, bool dusty) : model(std::move(bone)) {
  simulator = std::make_unique<bone::Simulator>(model, workshop(model));
  bone::CompanionParameters beside;
  beside.dusty = dusty;
  if (threads) {
    companions = std::make_unique<bone::ThreadedCompanions>(*simulator, beside);
  } else {
    companions = std::make_unique<bone::SteppedCompanions>(*simulator, beside, 1000.0);
  }
  new_pass();
}

void Workshop::new_pass(std::uint64_t sequence) {
  pass =
      std::make_unique<protocols::DrillingPass>(*simulator, *companions, parameters, logs, 1000.0);
  pass->begin(sequence);
}

device::DeviceReading at(const Eigen::Vector3d& p, std::uint32_t buttons) {
  device::DeviceReading reading;
  reading.tool.position = p;
  reading.buttons = buttons;
  return reading;
}

std::vector<device::DeviceReading> through_the_bridge(int ticks) {
  std::vector<device::DeviceReading> readings;
  for (int i = 0; i < ticks; ++i) {
    const double share = static_cast<double>(i) / ticks;
    // Down from above the blocks, which the burr touches first, through the bridge between them.
    const double y = 0.005 - 0.008 * share;
    const double sway = 0.0004 * std::sin(2.0 * std::numbers::pi * 0.003 * i);
    readings.push_back(at({sway, y, 0.5 * sway}, 1u));
  }
  return readings;
}

}  // namespace haptrial::test
