#include "core/device/mouse.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "core/base/definition/schema.h"

namespace haptrial::device {

const Schema<MouseParameters>& mouse_schema() {
  using P = MouseParameters;
  static const auto schema =
      Schema<P>()
          .number("pointer_speed", &P::pointer_speed, {0.0, 10.0, true}, "m/s",
                  "Greatest speed at which the simulated mass follows the pointer")
          .number("max_press", &P::max_press, {0.0, 100.0, true}, "N",
                  "Greatest force of a press of the left button")
          .number("first_press", &P::first_press, {0.0, 100.0}, "N",
                  "Force of a press when the left button goes down")
          .number("press_step", &P::press_step, {0.0, 100.0}, "N",
                  "Change of a press for each step of the mouse wheel")
          .integer("stop_button", &P::stop_button, -1, 31,
                   "Button of the mouse for emergency stops; -1: none");
  return schema;
}

MouseDevice::MouseDevice(const MouseParameters& parameters, double rate, const std::string& name)
    : parameters_(parameters),
      info_{name, parameters.electronics.max_force, parameters.electronics.workspace_radius, false},
      period_(1.0 / rate),
      mass_(parameters.coupling, parameters.start),
      electronics_(parameters.electronics, mass_, rate) {
  if (!(parameters.pointer_speed > 0.0 && parameters.max_press > 0.0)) {
    throw std::invalid_argument("MouseDevice: pointer_speed and max_press must be above 0");
  }
  info_.senses_orientation = parameters.in_space;
  asked_.hand.position = parameters.start;
  channel_.write(asked_);
}

bool MouseDevice::read(DeviceReading& reading) noexcept {
  channel_.read(pointer_);
  if (!electronics_.read(reading)) {
    return false;
  }
  reading.orientation = orientation_;
  reading.buttons = pointer_.buttons;
  reading.stop_pressed = is_pressed(pointer_.buttons, parameters_.stop_button);
  return true;
}

bool MouseDevice::write(const Wrench& wrench) noexcept {
  follow();
  return electronics_.write(wrench);
}

// A pointer jumps; the hand that it stands for does not.
void MouseDevice::follow() noexcept {
  const Eigen::Vector3d way = pointer_.hand.position - mass_.anchor();
  const double most = parameters_.pointer_speed * period_;
  const double length = way.norm();
  mass_.set_anchor(mass_.anchor() + (length > most ? most / length : 1.0) * way);
  mass_.set_press_force({0.0, -pointer_.press, 0.0});
  constexpr double kTurning = 6.0;  // at most [rad/s]
  const double angle = orientation_.angularDistance(pointer_.hand.orientation);
  const double share = angle > kTurning * period_ ? kTurning * period_ / angle : 1.0;
  orientation_ = orientation_.slerp(share, pointer_.hand.orientation).normalized();
}

void MouseDevice::move(double x, double z) noexcept {
  if (!parameters_.in_space && std::isfinite(x) && std::isfinite(z)) {
    asked_.hand.position = within({x, height_, z});
    channel_.write(asked_);
  }
}

void MouseDevice::reach(const HandPose& pose) noexcept {
  if (pose.position.allFinite() && pose.orientation.coeffs().allFinite() &&
      pose.orientation.norm() > 0.0) {
    asked_.hand = {within(pose.position), pose.orientation.normalized()};
    channel_.write(asked_);
  }
}

/// The mass swings past a bit: the hand stays short of the end of the workspace.
Eigen::Vector3d MouseDevice::within(const Eigen::Vector3d& point) const noexcept {
  const double most = 0.9 * info_.workspace_radius;
  const double length = point.norm();
  return (length > most ? most / length : 1.0) * point;
}

void MouseDevice::press(double force) noexcept {
  if (std::isfinite(force)) {
    asked_.press = std::clamp(force, 0.0, parameters_.max_press);
    channel_.write(asked_);
  }
}

void MouseDevice::turn_wheel(double wheel, bool pressed) noexcept {
  if (!std::isfinite(wheel)) {
    return;
  }
  const double steps = wheel - std::exchange(wheel_, wheel);
  if (pressed) {
    pressed_steps_ += steps;
    press(parameters_.first_press + parameters_.press_step * pressed_steps_);
    return;
  }
  constexpr double kLift = 0.002;  // [m]
  const double most = info_.workspace_radius;
  height_ = std::clamp(height_ + kLift * steps, -most, most);
  press(0.0);
}

void MouseDevice::set_buttons(std::uint32_t buttons) noexcept {
  asked_.buttons = buttons;
  channel_.write(asked_);
}

}  // namespace haptrial::device
