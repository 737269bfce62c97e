#pragma once

#include <charconv>
#include <cmath>
#include <numbers>

#include "core/base/error.h"
#include "core/device/registered_devices.h"

/// A device that needs no hardware: its handle goes round in a circle. --device circle, or
/// circle:RADIUS.
namespace own {

using namespace haptrial;

class Circle final : public device::Device {
 public:
  Circle(double radius, double rate) : radius_(radius), period_(1.0 / rate) {
    info_.name = "circle";
    info_.simulated = true;
  }
  const device::DeviceInfo& info() const noexcept override { return info_; }
  bool read(device::DeviceReading& reading) noexcept override {
    constexpr double kTurn = 2.0 * std::numbers::pi;  // a turn a second [rad/s]
    time_ += period_;
    const double c = std::cos(kTurn * time_);
    const double s = std::sin(kTurn * time_);
    reading.tool.position = {radius_ * c, 0.0, radius_ * s};
    reading.tool.velocity = {-kTurn * radius_ * s, 0.0, kTurn * radius_ * c};
    return true;
  }
  bool write(const device::Wrench&) noexcept override { return true; }

 private:
  device::DeviceInfo info_;
  double radius_;  // [m]
  double period_;  // [s]
  double time_{0.0};
};

inline std::unique_ptr<device::Device> open_circle(const std::string& setting, int, double rate) {
  double radius = 0.02;
  const char* const end = setting.data() + setting.size();
  const auto [at, error] = std::from_chars(setting.data(), end, radius);
  const bool read = setting.empty() || (error == std::errc() && at == end);
  if (!read || !(radius > 0.0 && radius <= 0.07)) {
    throw InputError("--device circle:" + setting + "; allowed: a radius up to 0.07 [m]");
  }
  return std::make_unique<Circle>(radius, rate);
}

inline void add_circle() {
  device::register_device(
      {"circle", "a handle that goes round by itself, once a second", open_circle});
}

}  // namespace own
