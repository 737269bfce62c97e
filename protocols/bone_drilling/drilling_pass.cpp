#include "protocols/bone_drilling/drilling_pass.h"

#include <algorithm>
#include <stdexcept>

#include "core/base/shortest_turn.h"
#include "core/control/pd_controller.h"
#include "core/record/table/schema.h"

namespace haptrial::protocols {
namespace {

Eigen::Quaterniond grip_of(const Eigen::Vector3d& handle, double scale) {
  if (!(handle.norm() > 0.0) || !handle.allFinite() || !(scale > 0.0)) {
    throw std::invalid_argument(
        "DrillingInput: the handle must have a length and the scale be above 0");
  }
  return shortest_turn(Eigen::Vector3d::UnitZ(), handle);
}

ToolState tool_of(const device::DeviceReading& reading, const Eigen::Quaterniond& grip,
                  double scale) noexcept {
  return {{reading.tool.position / scale, reading.tool.velocity / scale},
          reading.orientation.normalized() * grip};
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
    : parameters_(parameters),
      grip_(grip_of(parameters.handle, parameters.scale)),
      second_grip_(parameters.second ? grip_of(parameters.second->handle, parameters.scale)
                                     : grip_) {}

bone::SimulatorInput DrillingInput::of(const device::DeviceReading& recorded, double dt,
                                       const device::DeviceReading* second) const noexcept {
  bone::SimulatorInput input;
  input.tool = tool_of(recorded, grip_, parameters_.scale);
  if (second != nullptr && parameters_.second) {
    input.tube.tool = tool_of(*second, second_grip_, parameters_.scale);
    input.tube.sucks = (second->buttons & parameters_.second->suck) != 0;
    input.tube.rinses = (second->buttons & parameters_.second->rinse) != 0;
  }
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
  view.turned = simulator.shown_turn();
  view.contact = out.contact;
  view.sound_force = out.force.norm();
  view.eye = camera.eye;
  view.target = camera.target;
  view.up = camera.up;
  view.field_of_view = camera.field_of_view;
  view.stills_asked = simulator.stills_asked();
  if (simulator.tube() != nullptr) {
    const bone::TubeInput& tube = input.tube;
    view.tube = {true, tube.tool.tip.position, tube.tool.orientation, tube.sucks, tube.rinses};
  }
  view.injury = simulator.last_injury();
  view.dents = {simulator.soft_tissue().dent(), simulator.soft_tissue().dent_of_second()};
  view.reversed = simulator.handpiece().reversed();
  view.sharpness = simulator.handpiece().sharpness(out.tool);
  view.temperature = simulator.heat() != nullptr ? simulator.heat()->temperature() : 0.0;
  return view;
}

Eigen::Vector3d shaking(sound::DrillVibration* vibration, const bone::Simulator& simulator,
                        bool contact, double force, const ToolState& tool) noexcept {
  const auto* burr = simulator.tool().as<bone::BurrTool>();
  if (vibration == nullptr || burr == nullptr) {
    return Eigen::Vector3d::Zero();
  }
  sound::DrillState state;
  state.burr =
      burr->burr.kind == bone::BurrKind::kDiamond ? sound::Burr::kDiamond : sound::Burr::kCutting;
  state.speed = simulator.output().power;
  state.contact = contact;
  state.force = force;
  return vibration->tick(state, tool);
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
      rows_(simulator, logs, rate),
      vibration_(vibration),
      nerves_(nerves),
      time_limit_(static_cast<std::uint64_t>(std::max(1.0, parameters.time_limit * rate))),
      ticks_(spent) {}

void DrillingPass::begin(std::uint64_t sequence) noexcept {
  sequence_ = sequence;
  first_ = true;
  if (shared_ != nullptr) {
    shared_->tell_begin();
  }
}

PassOutput DrillingPass::tick(const Readings& readings, double dt) noexcept {
  const device::DeviceReading& reading = readings[0];
  const device::DeviceReading recorded = as_recorded(reading);
  const bool two = parameters_.second && readings.size() > 1;
  const device::DeviceReading second = two ? second_as_recorded(readings[1]) : reading;
  const bone::SimulatorInput input = input_.of(recorded, dt, two ? &second : nullptr);
  if (first_) {
    simulator_.begin(input.functions);
  }
  if (const std::uint64_t changes = tuning_ != nullptr ? tuning_->take(simulator_, vibration_) : 0;
      changes > 0) {
    logs_.tunings.push({sequence_, changes});
  }
  const int tool_before = simulator_.output().tool;
  const bone::HandMode mode_before = simulator_.output().mode;
  const bone::SimulatorOutput& done = simulator_.tick(input);
  const bool other_touch = !first_ && (done.tool != tool_before || done.mode != mode_before);
  companions_.after_tick(simulator_, dt);
  if (nerves_ != nullptr) {
    logs_.set_nerves(nerves_->step(tool_at_nerves(simulator_, input)));
  }
  rows_.log(sequence_, input.tool.tip.velocity.norm());
  rows_.log_camera(sequence_, done.camera_changed);
  rows_.log_pieces(sequence_);
  if (hints_ != nullptr) {
    tell_hints(*hints_, sequence_, simulator_, input);
  }
  const Eigen::Vector3d kept_out = guard_ != nullptr
                                       ? guard_->tick(sequence_, simulator_, input, logs_)
                                       : Eigen::Vector3d::Zero();
  if (shared_ != nullptr) {
    shared_->tell_step(recorded, simulator_);
  }
  ++ticks_;
  ++sequence_;
  first_ = false;
  if (done.finished || ticks_ >= time_limit_) {
    state_ = PassState::kCompleted;
    if (shared_ != nullptr) {
      shared_->tell_end();
    }
  }

  PassOutput out;
  const Eigen::Vector3d shake =
      shaking(vibration_, simulator_, done.contact, done.force.norm(), input.tool);
  const Eigen::Vector3d wanted =
      reading.shares.stiffness * (done.force + done.shaft + done.pushed + kept_out) + shake;
  out.most = parameters_.force_limit;
  out.force = control::saturate(wanted, out.most);
  // One hand works on the other, which is no energy that the program makes.
  out.intent.push = reading.shares.stiffness * (done.drag + done.pushed) + shake;
  out.intent.stimulus = shake;
  out.goes_over = other_touch;
  out.saturated = wanted.norm() > out.most;
  out.stage = record::Stage::kRun;
  bone::DrillingView seen = view_of(simulator_, input);
  seen.progress = static_cast<double>(ticks_) / static_cast<double>(time_limit_);
  seen.time_limit = parameters_.time_limit;
  seen.elapsed = seen.progress * seen.time_limit;
  seen.tone = logs_.nerve_tone();
  if (hints_ != nullptr) {
    const hint::HintsNow now = hints_->now();
    seen.hints = now.kinds;
    seen.hint_structure = now.structure;
  }
  out.shown = seen;
  out.shown.tool = reading.tool.position;
  if (two) {
    const Eigen::Vector3d on_tube =
        readings[1].shares.stiffness * (done.tube.force + done.tube.shaft - done.pushed);
    second_.most = parameters_.second->force_limit;
    second_.force = control::saturate(on_tube, second_.most);
    second_.intent.push = -readings[1].shares.stiffness * done.pushed;
    second_.goes_over = other_touch;
    rows_.log_second(input.tube);
  }
  rows_.log_tool(done.removed + done.cut, done.force);
  rows_.log_handpiece(done.shaft);
  return out;
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
