#include "core/device/haply.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/base/definition/schema.h"

namespace haptrial::device {
namespace {

// Radii of the sphere about the middle in which the maker's own examples keep the cursor [m].
constexpr double kRadius = 0.1;
constexpr double kMinverseRadius = 0.04;

Eigen::Vector3d world_of(const Eigen::Vector3d& v) noexcept { return {v.x(), v.z(), -v.y()}; }
Eigen::Vector3d service_of(const Eigen::Vector3d& v) noexcept { return {v.x(), -v.z(), v.y()}; }

HaplyAddress address_of(const HaplyParameters& p, double rate, int number) {
  const bool good = p.port >= 0 && p.port < 65536 && p.max_force > 0.0 &&
                    p.workspace_radius > 0.0 && p.patience > 0.0 && p.origin.allFinite() &&
                    rate > 0.0 && number >= 0;
  if (!good) {
    throw std::invalid_argument("HaplyDevice: a parameter is out of its bounds");
  }
  return {p.port, p.device_id, p.grip_id, number, p.patience};
}

std::string name_of(const HaplyListing& device) {
  const std::string type = device.type.empty() ? "device" : device.type;
  return device.handedness.empty()
             ? fmt::format("Haply {} {}", type, device.id)
             : fmt::format("Haply {} {} ({}-handed)", type, device.id, device.handedness);
}

}  // namespace

const Schema<HaplyParameters>& haply_schema() {
  using P = HaplyParameters;
  static const auto schema =
      Schema<P>()
          .integer("port", &P::port, 0, 65535,
                   "Port of the Inverse Service on this computer; 0: 10001, or 10000 if nobody "
                   "answers there")
          .text("device_id", &P::device_id,
                "Identifier of the device, as Haply Hub shows it; empty: the first one that the "
                "service lists")
          .otherwise("the first one")
          .text("grip_id", &P::grip_id,
                "Identifier of the VerseGrip; empty: the first one that the service lists, or none")
          .otherwise("the first one, or none")
          .number("max_force", &P::max_force, {0.0, 20.0, true}, "N",
                  "Force at which the driver saturates; at most what the device's data sheet gives")
          .number("workspace_radius", &P::workspace_radius, {0.0, 1.0, true}, "m",
                  "Radius of the device's workspace; at most 0.1 m is used, and 0.04 m with a "
                  "Minverse")
          .vector("origin", &P::origin, {-1.0, 1.0}, "m",
                  "Middle of the workspace from the middle of the device's mounting face, in the "
                  "device's axes: to the right, away from the user, up")
          .otherwise("[0, -0.12, 0.15]")
          .number("patience", &P::patience, {0.002, 1.0}, "s",
                  "Silence between the loop and the Inverse Service after which the force is "
                  "switched off")
          .integer("stop_button", &P::stop_button, -1, 2,
                   "Button of the VerseGrip for emergency stops, 0 to 2 for a, b and c; -1: none");
  return schema;
}

HaplyDevice::HaplyDevice(const HaplyParameters& parameters, double rate, int number)
    : parameters_(parameters),
      link_(address_of(parameters, rate, number)),
      patience_ticks_(std::max(1, static_cast<int>(std::lround(parameters.patience * rate)))) {
  const double radius = link_.device().type == "minverse" ? kMinverseRadius : kRadius;
  info_ = {name_of(link_.device()), parameters.max_force,
           std::min(parameters.workspace_radius, radius), false, link_.has_grip()};
}

bool HaplyDevice::read(DeviceReading& reading) noexcept {
  if (link_.read(latest_)) {
    ticks_without_news_ = 0;
  } else {
    stale_.fetch_add(1, std::memory_order_relaxed);
    ++ticks_without_news_;
  }
  if (latest_.fault != HaplyFault::kNone || ticks_without_news_ > patience_ticks_) {
    trouble_ = describe(latest_.fault != HaplyFault::kNone ? latest_.fault : HaplyFault::kSilent);
    return false;
  }
  trouble_ = describe(latest_.status);
  reading.tool.position = world_of(latest_.cursor.position - parameters_.origin);
  reading.tool.velocity = world_of(latest_.cursor.velocity);
  const Eigen::Vector3d axis = world_of(latest_.orientation.vec());
  reading.orientation = Eigen::Quaterniond(latest_.orientation.w(), axis.x(), axis.y(), axis.z());
  reading.buttons = latest_.buttons;
  reading.stop_pressed = is_pressed(latest_.buttons, parameters_.stop_button);
  reading.forces_on = latest_.status == HaplyFault::kNone;
  return true;
}

bool HaplyDevice::write(const Wrench& wrench) noexcept {
  const double size = wrench.force.norm();
  const double share = size > info_.max_force ? info_.max_force / size : 1.0;
  link_.write(service_of(share * wrench.force));
  return true;
}

}  // namespace haptrial::device
