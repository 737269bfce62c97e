#include "protocols/bone_drilling/drilling_pass.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "core/control/pd_controller.h"
#include "core/record/table/rounding.h"
#include "core/record/table/schema.h"

namespace haptrial::protocols {
namespace {

constexpr std::uint64_t kBetweenCameraRows = 10;  // ticks at least, while the view moves

Eigen::Quaterniond grip_of(const DrillingParameters& p) {
  if (!(p.handle.norm() > 0.0) || !p.handle.allFinite() || !(p.scale > 0.0)) {
    throw std::invalid_argument(
        "DrillingInput: the handle must have a length and the scale be above 0");
  }
  return Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), p.handle);
}

std::array<std::int32_t, 3> indices(const bone::Voxel& voxel) noexcept {
  return {voxel.x(), voxel.y(), voxel.z()};
}

}  // namespace

device::DeviceReading as_recorded(const device::DeviceReading& reading) noexcept {
  device::DeviceReading grid = reading;
  for (Eigen::Index a = 0; a < 3; ++a) {
    grid.tool.position[a] = record::on_grid(reading.tool.position[a], record::kPositionResolution);
    grid.tool.velocity[a] = record::on_grid(reading.tool.velocity[a], record::kVelocityResolution);
  }
  for (double& number : grid.orientation.coeffs()) {
    number = record::on_grid(number, record::kOrientationResolution);
  }
  grid.pedal = record::on_grid(reading.pedal, record::kPedalResolution);
  return grid;
}

DrillingInput::DrillingInput(const DrillingParameters& parameters)
    : parameters_(parameters), grip_(grip_of(parameters)) {}

bone::SimulatorInput DrillingInput::of(const device::DeviceReading& recorded,
                                       double dt) const noexcept {
  bone::SimulatorInput input;
  input.tool.tip.position = recorded.tool.position / parameters_.scale;
  input.tool.tip.velocity = recorded.tool.velocity / parameters_.scale;
  input.tool.orientation = recorded.orientation.normalized() * grip_;
  input.functions = functions_of(parameters_.controls, recorded);
  input.power = power_of(parameters_.controls, recorded, input.functions);
  input.dt = dt;
  return input;
}

bone::DrillingView view_of(const bone::Simulator& simulator,
                           const bone::SimulatorInput& input) noexcept {
  const bone::SimulatorOutput& out = simulator.output();
  const Camera& camera = simulator.camera();
  bone::DrillingView view;
  view.shown = true;
  view.tip = input.tool.tip.position;
  view.orientation = input.tool.orientation;
  view.tool = out.tool;
  view.power = out.power > 0.0;
  view.contact = out.contact;
  view.sound_force = out.force.norm();
  view.eye = camera.eye;
  view.target = camera.target;
  view.up = camera.up;
  view.field_of_view = camera.field_of_view;
  view.stills_asked = simulator.stills_asked();
  return view;
}

DrillingPass::DrillingPass(bone::Simulator& simulator, bone::Companions& companions,
                           const DrillingParameters& parameters, DrillingLogs& logs, double rate,
                           std::uint64_t spent, sound::DrillVibration* vibration,
                           nerve::NerveExposures* nerves)
    : simulator_(simulator),
      companions_(companions),
      parameters_(parameters),
      input_(parameters),
      logs_(logs),
      rate_(rate),
      vibration_(vibration),
      nerves_(nerves),
      time_limit_(static_cast<std::uint64_t>(std::max(1.0, parameters.time_limit * rate))),
      ticks_(spent) {}

void DrillingPass::begin(std::uint64_t sequence) noexcept {
  sequence_ = sequence;
  first_ = true;
  camera_due_ = true;
}

void DrillingLogs::record(std::uint64_t sequence, const Readings& readings,
                          device::Fault /*fault*/) noexcept {
  record::ToolRow row = std::exchange(row_, record::ToolRow{});
  row.sequence = sequence;
  row.orientation = readings[0].orientation;
  row.buttons = readings[0].buttons;
  row.keys = readings[0].keys;
  row.pedal = readings[0].pedal;
  tool.push(row);
  if (beside_ != nullptr) {
    nerve::NerveTick tick = std::exchange(nerves_, nerve::NerveTick{});
    tick.sequence = sequence;
    beside_->after_tick(tick);
  }
}

PassOutput DrillingPass::tick(const Readings& readings, double dt) noexcept {
  const device::DeviceReading& reading = readings[0];
  const device::DeviceReading recorded = as_recorded(reading);
  const bone::SimulatorInput input = input_.of(recorded, dt);
  if (first_) {
    simulator_.begin(input.functions);
  }
  const bone::SimulatorOutput& done = simulator_.tick(input);
  companions_.after_tick(simulator_, dt);
  if (nerves_ != nullptr) {
    logs_.set_nerves(nerves_->step(tool_at_nerves(input)));
  }
  log(done, input.tool.tip.velocity.norm());
  log_camera(done.camera_changed);
  ++ticks_;
  ++sequence_;
  first_ = false;
  if (done.finished || ticks_ >= time_limit_) {
    state_ = PassState::kCompleted;
  }

  PassOutput out;
  const Eigen::Vector3d shake = shaking(input);
  const Eigen::Vector3d wanted = done.force + shake;
  out.force = control::saturate(wanted, parameters_.force_limit);
  out.intent.push = done.drag + shake;
  out.saturated = wanted.norm() > parameters_.force_limit;
  out.applied_force = out.force.y();
  out.stage = record::Stage::kRun;
  bone::DrillingView seen = view_of(simulator_, input);
  seen.progress = static_cast<double>(ticks_) / static_cast<double>(time_limit_);
  seen.time_limit = parameters_.time_limit;
  seen.tone = logs_.nerve_tone();
  out.shown = seen;
  out.shown.tool = reading.tool.position;
  record::ToolRow tool;
  tool.tool = done.tool;
  tool.mode = static_cast<std::uint8_t>(done.mode);
  tool.active = true;
  tool.power = done.power > 0.0;
  tool.piece = simulator_.world().held();
  tool.immersed = done.immersed;
  tool.removed = done.removed + done.cut;
  tool.contact = done.force;
  logs_.set_tool(tool);
  return out;
}

/// Nerves lie in the bone that was there at the beginning, and go with it.
nerve::ToolAtNerves DrillingPass::tool_at_nerves(const bone::SimulatorInput& input) const noexcept {
  using Kind = nerve::ToolAtNerves::Kind;
  const bone::SimulatorOutput& out = simulator_.output();
  const bone::ToolSpec& tool = simulator_.tool();
  nerve::ToolAtNerves at;
  if (out.mode != bone::HandMode::kTool) {
    return at;
  }
  if (const auto* burr = tool.as<bone::BurrTool>()) {
    at.kind = Kind::kBurr;
    at.radius = burr->radius();
  } else if (const auto* suction = tool.as<bone::SuctionTool>()) {
    at.kind = Kind::kSuction;
    at.radius = suction->radius;
  } else if (const auto* probe = tool.as<bone::ProbeTool>()) {
    at.kind = Kind::kProbe;
    at.radius = probe->radius;
  }
  const Eigen::Isometry3d& X_WB = std::as_const(simulator_).world().pose(0);
  at.tip_B = X_WB.inverse(Eigen::Isometry) * input.tool.tip.position;
  at.speed = input.tool.tip.velocity.norm();
  at.force = out.force.norm();
  at.power = out.power;
  return at;
}

/// Felt, but neither drilled with nor recorded as contact.
Eigen::Vector3d DrillingPass::shaking(const bone::SimulatorInput& input) noexcept {
  const bone::ToolSpec& tool = simulator_.tool();
  const auto* burr = tool.as<bone::BurrTool>();
  if (vibration_ == nullptr || burr == nullptr) {
    return Eigen::Vector3d::Zero();
  }
  const bone::SimulatorOutput& out = simulator_.output();
  sound::DrillState state;
  state.burr =
      burr->burr.kind == bone::BurrKind::kDiamond ? sound::Burr::kDiamond : sound::Burr::kCutting;
  state.speed = out.power;
  state.contact = out.contact;
  state.force = out.force.norm();
  return vibration_->tick(state, input.tool);
}

void DrillingPass::log(const bone::SimulatorOutput& out, double speed) noexcept {
  const double force = out.force.norm();
  for (const bone::EmptiedIn& gone : simulator_.emptied()) {
    record::RemovalRow row;
    row.sequence = sequence_;
    row.piece = gone.piece;
    row.voxel = indices(gone.voxel);
    row.label = gone.label;
    row.cut = gone.by_cut;
    row.force = gone.by_cut ? 0.0 : force;
    row.speed = speed;
    logs_.removals.push(row);
  }
  for (const bone::Tear& tear : simulator_.tears()) {
    logs_.tears.push(
        {sequence_, tear.label, out.tool, tear.by_suction, tear.force, tear.depth, tear.place_B});
  }
  for (const bone::WorldEvent& event : simulator_.separations()) {
    using Kind = bone::WorldEvent::Kind;
    if (event.kind == Kind::kBorn) {
      for (const bone::Voxel& seed : simulator_.world().seeds(event.piece)) {
        logs_.splits.push({sequence_, event.parent, event.piece, indices(seed)});
      }
    } else if (event.kind == Kind::kCrumb) {
      logs_.splits.push({sequence_, event.piece, -1, indices(event.seed)});
    }
  }
}

/// A moving view is logged a hundred times a second at most, and where it comes to rest.
void DrillingPass::log_camera(bool changed) noexcept {
  camera_due_ = camera_due_ || changed;
  const bool at_rest = !changed;
  if (!camera_due_ || !(first_ || at_rest || sequence_ - camera_logged_ >= kBetweenCameraRows)) {
    return;
  }
  const Camera& camera = simulator_.camera();
  record::CameraRow row;
  row.sequence = sequence_;
  row.time_ns = std::llround(static_cast<double>(sequence_) * 1e9 / rate_);
  row.eye = camera.eye;
  row.target = camera.target;
  row.up = camera.up;
  row.field_of_view = camera.field_of_view;
  logs_.camera.push(row);
  camera_logged_ = sequence_;
  camera_due_ = false;
}

bool DrillingPass::wants_attention() noexcept {
  std::size_t at = 0;
  bool wants = false;
  const auto look = [&](const auto& log) {
    const std::uint64_t since = log.pushed() - attended_[at++];
    wants = wants || since >= log.capacity() / 4;
  };
  look(logs_.removals);
  look(logs_.camera);
  look(logs_.splits);
  if (wants) {
    attended_ = {logs_.removals.pushed(), logs_.camera.pushed(), logs_.splits.pushed()};
  }
  return wants;
}

}  // namespace haptrial::protocols
