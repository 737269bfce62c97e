#include "core/device/mouse.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/base/definition/table.h"

namespace haptrial::device {

MouseParameters read_mouse_parameters(Table& table) {
  MouseParameters p;
  p.pointer_speed = table.number("pointer_speed", {0.0, 10.0, true}, "m/s");
  p.max_press = table.number("max_press", {0.0, 100.0, true}, "N");
  p.first_press = table.number("first_press", {0.0, 100.0}, "N");
  p.press_step = table.number("press_step", {0.0, 100.0}, "N");
  p.stop_button = static_cast<int>(table.integer("stop_button", -1, 31));
  return p;
}

MouseDevice::MouseDevice(const MouseParameters& parameters, double rate)
    : parameters_(parameters),
      info_{"mouse", parameters.electronics.max_force, parameters.electronics.workspace_radius,
            false},
      period_(1.0 / rate),
      mass_(parameters.coupling),
      electronics_(parameters.electronics, mass_, rate) {
  if (!(parameters.pointer_speed > 0.0 && parameters.max_press > 0.0)) {
    throw std::invalid_argument("MouseDevice: pointer_speed and max_press must be above 0");
  }
}

bool MouseDevice::read(DeviceReading& reading) noexcept {
  channel_.read(pointer_);
  if (!electronics_.read(reading)) {
    return false;
  }
  reading.buttons = pointer_.buttons;
  reading.stop_pressed = is_pressed(pointer_.buttons, parameters_.stop_button);
  return true;
}

bool MouseDevice::write(const Eigen::Vector3d& force) noexcept {
  follow();
  return electronics_.write(force);
}

// A pointer jumps; the hand that it stands for does not.
void MouseDevice::follow() noexcept {
  const Eigen::Vector3d way = Eigen::Vector3d(pointer_.x, 0.0, pointer_.z) - mass_.anchor();
  const double most = parameters_.pointer_speed * period_;
  const double length = way.norm();
  mass_.set_anchor(mass_.anchor() + (length > most ? most / length : 1.0) * way);
  mass_.set_press_force({0.0, -pointer_.press, 0.0});
}

void MouseDevice::move(double x, double z) noexcept {
  if (!std::isfinite(x) || !std::isfinite(z)) {
    return;
  }
  // The mass swings past a bit: the pointer stays short of the end of the workspace.
  const double most = 0.9 * info_.workspace_radius;
  const double length = std::hypot(x, z);
  const double share = length > most ? most / length : 1.0;
  asked_.x = share * x;
  asked_.z = share * z;
  channel_.write(asked_);
}

void MouseDevice::press(double force) noexcept {
  if (std::isfinite(force)) {
    asked_.press = std::clamp(force, 0.0, parameters_.max_press);
    channel_.write(asked_);
  }
}

double MouseDevice::press_at(double wheel) const noexcept {
  return std::max(0.0, parameters_.first_press + parameters_.press_step * wheel);
}

void MouseDevice::set_buttons(std::uint32_t buttons) noexcept {
  asked_.buttons = buttons;
  channel_.write(asked_);
}

}  // namespace haptrial::device
