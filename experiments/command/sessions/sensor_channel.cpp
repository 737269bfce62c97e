#include "experiments/command/sessions/sensor_channel.h"

#include <fmt/format.h>
#include <Eigen/LU>

#include <algorithm>
#include <chrono>
#include <sstream>
#include <string_view>
#include <utility>

#include "core/base/error.h"

namespace haptrial::experiments {
namespace {

/// Quantities of a sensor: three along or about its axes, or the only one three times.
std::array<const char*, 3> quantities_of(device::Part part) {
  switch (part) {
    case device::Part::kRotation:
      return {"tx", "ty", "tz"};
    case device::Part::kGrip:
      return {"grip", "grip", "grip"};
    case device::Part::kTip:
      break;
  }
  return {"fx", "fy", "fz"};
}

std::array<std::size_t, 3> places_of_force(const channel::ChannelOptions& options,
                                           device::Part part) {
  const std::array kForces = quantities_of(part);
  const char* unit = device::units_of(part, 1.0).force;
  const auto& quantities = options.plan.quantities;
  std::array<std::size_t, 3> places{};
  for (std::size_t i = 0; i < places.size(); ++i) {
    const auto at = std::ranges::find(quantities, kForces[i], &channel::Quantity::name);
    if (at == quantities.end() || at->unit != unit) {
      throw InputError(fmt::format(
          "channels.{}: a force sensor of a {} has the quantities {} in {}; {} is not among them",
          options.name, device::part_word(part),
          part == device::Part::kGrip
              ? std::string(kForces[0])
              : fmt::format("{}, {} and {}", kForces[0], kForces[1], kForces[2]),
          unit, kForces[i]));
    }
    places[i] = static_cast<std::size_t>(at - quantities.begin());
  }
  return places;
}

/// Time from now on [ns].
channel::Channel::Now machine_clock() {
  const auto start = std::chrono::steady_clock::now();
  return [start] {
    return std::chrono::nanoseconds(std::chrono::steady_clock::now() - start).count();
  };
}

/// The axis of "-z"; zero for anything else.
Eigen::Vector3d axis_of(std::string_view word) {
  const bool back = word.starts_with('-');
  word.remove_prefix(back ? 1 : 0);
  Eigen::Vector3d axis = Eigen::Vector3d::Zero();
  if (word == "x" || word == "y" || word == "z") {
    axis[word[0] - 'x'] = back ? -1.0 : 1.0;
  }
  return axis;
}

}  // namespace

bool measures(const channel::ChannelOptions& options, device::Part part) {
  const auto& quantities = options.plan.quantities;
  return std::ranges::all_of(quantities_of(part), [&](const char* name) {
    return std::ranges::find(quantities, name, &channel::Quantity::name) != quantities.end();
  });
}

Eigen::Matrix3d rotation_of_axes(const std::string& axes) {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Zero();
  std::istringstream words(axes);
  std::string word;
  Eigen::Index column = 0;
  while (std::getline(words, word, ',')) {
    if (column < 3) {
      rotation.col(column) = axis_of(word);
    }
    ++column;
  }
  if (column != 3 || rotation.determinant() != 1.0) {
    throw InputError(
        fmt::format("--sensor-axes is {}; allowed: three axes that are at right angles and "
                    "right-handed, such as x,y,z or x,-z,y",
                    axes));
  }
  return rotation;
}

SensorChannel::SensorChannel(const channel::ChannelOptions& options, const std::string& axes,
                             channel::Channel::Now now, device::Part of, double radius)
    : now_(now ? std::move(now) : machine_clock()),
      to_world_(rotation_of_axes(axes)),
      force_(places_of_force(options, of)),
      is_grip_(of == device::Part::kGrip),
      newton_(device::units_of(of, radius).newton),
      channel_(options, now_) {
  if (const std::string why = channel_.wait_until_open(); !why.empty()) {
    throw RunError(why);
  }
  channel_.begin();
}

bool SensorChannel::read(device::MeasuredForce& measured) noexcept {
  const channel::ChannelState& state = channel_.newest();
  const Eigen::Vector3d force(state.values[force_[0]], state.values[force_[1]],
                              state.values[force_[2]]);
  if (!state.live || !force.allFinite()) {
    return false;
  }
  measured.force = is_grip_ ? Eigen::Vector3d(force.x(), 0.0, 0.0)
                            : Eigen::Vector3d(to_world_ * force / newton_);
  measured.age = std::max(0.0, 1e-9 * static_cast<double>(now_() - state.time_ns));
  measured.time = 1e-9 * static_cast<double>(state.time_ns);
  measured.noise = 0.0;
  return true;
}

}  // namespace haptrial::experiments
