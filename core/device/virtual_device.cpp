#include "core/device/virtual_device.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/base/definition/schema.h"
#include "core/base/longer.h"

namespace haptrial::device {

const Schema<VirtualDeviceParameters>& virtual_device_schema() {
  using P = VirtualDeviceParameters;
  static const auto schema =
      Schema<P>()
          .number("max_force", &P::max_force, {0.0, 100.0, true}, "N",
                  "Force at which the virtual device's motors saturate")
          .required()
          .number("workspace_radius", &P::workspace_radius, {0.0, 2.0, true}, "m",
                  "Radius of the virtual device's workspace")
          .required()
          .number("position_quantum", &P::position_quantum, {0.0, 1e-3}, "m",
                  "Resolution of the virtual device's encoders")
          .required()
          .integer("velocity_window", &P::velocity_window, 2, 64,
                   "Milliseconds of readings over which velocity is estimated")
          .required()
          .integer("force_delay", &P::force_delay, 1, 8,
                   "Ticks from a command to the force that the hand feels")
          .table(
              "faults", &P::faults, motor_faults_schema(),
              "Faults of the virtual device's motors, with which a certificate can be rehearsed");
  return schema;
}

int readings_in_window(int milliseconds, double rate) noexcept {
  return std::max(2, static_cast<int>(std::lround(1e-3 * milliseconds * rate)));
}

VirtualDevice::VirtualDevice(const VirtualDeviceParameters& parameters, HandlePhysics& physics,
                             double rate)
    : readings_(readings_in_window(parameters.velocity_window, rate)),
      parameters_(parameters),
      info_{"virtual", parameters.max_force, parameters.workspace_radius, true},
      physics_(physics),
      period_(1.0 / rate),
      motors_(parameters.faults, rate > 0.0 ? period_ : 1.0) {
  const int n = readings_;
  if (parameters.velocity_window < 2 || parameters.velocity_window > 64 || n > kMaxWindow ||
      !(rate > 0.0) || !(parameters.max_force > 0.0) || !(parameters.position_quantum >= 0.0) ||
      parameters.force_delay < 1 || parameters.force_delay > kMaxDelay) {
    throw std::invalid_argument(
        "VirtualDevice: rate and max_force must be above 0, position_quantum at least 0, "
        "velocity_window from 2 to 64 ms and at most 1024 readings, and force_delay from 1 to 8");
  }
  slope_gain_ = 12.0 / (static_cast<double>(n) * (n * n - 1.0) * period_);
  history_.fill(Eigen::Vector3d::Zero());
  pending_.fill(Eigen::Vector3d::Zero());
  for (int i = 0; i < n; ++i) {
    sense(physics_.state().position);
  }
}

void VirtualDevice::sense(const Eigen::Vector3d& position) noexcept {
  const double q = parameters_.position_quantum;
  newest_ = newest_ + 1 < readings_ ? newest_ + 1 : 0;
  for (int axis = 0; axis < 3; ++axis) {
    history_[newest_][axis] = q > 0.0 ? q * std::nearbyint(position[axis] / q) : position[axis];
  }
}

bool VirtualDevice::read(DeviceReading& reading) noexcept {
  const int n = readings_;
  Eigen::Vector3d slope = Eigen::Vector3d::Zero();
  int at = newest_;
  for (int age = 0; age < n; ++age) {
    slope += (0.5 * (n - 1) - age) * history_[at];
    at = at > 0 ? at - 1 : n - 1;
  }
  reading.tool.position = history_[newest_];
  reading.tool.velocity = slope_gain_ * slope;
  reading.buttons = held_.buttons;
  reading.pedal = held_.pedal;
  reading.orientation = held_.orientation;
  return true;
}

bool VirtualDevice::write(const Wrench& wrench) noexcept {
  Eigen::Vector3d& arrived = pending_[static_cast<std::size_t>(oldest_)];
  if (longer(arrived, parameters_.max_force)) {
    arrived *= parameters_.max_force / arrived.norm();
  }
  const PointState now = physics_.state();
  const Eigen::Vector3d soon = now.position + period_ * now.velocity;
  sense(physics_.step(motors_.force(arrived, soon), period_).position);
  arrived = wrench.force;
  oldest_ = oldest_ + 1 < parameters_.force_delay ? oldest_ + 1 : 0;
  return true;
}

}  // namespace haptrial::device
