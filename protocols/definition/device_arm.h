#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "core/device/envelope.h"
#include "core/device/handle_part.h"
#include "core/device/motor_faults.h"

namespace haptrial::protocols {

/// A part of a device that sessions drive (core/device/handle_part.h), as a definition states it.
struct DeviceArm {
  device::EnvelopeLimits limits;
  std::string name{};  // in sentences; empty: the only one
  device::Part part{device::Part::kTip};
  std::size_t of{0};                    // number of the arm that is the tip of its device
  double radius{1.0};                   // of the fingers about the axis of a rotation [m]
  std::optional<double> handle_mass{};  // at the fingers, in place of that of [hand] [kg]
  // Faults of a virtual device's motors there, in N and m at the fingers; nothing: [device] has
  // them.
  std::optional<device::MotorFaults> faults{};

  device::PartUnits units() const { return device::units_of(part, radius); }
};

/// How many devices these are.
inline int tips_of(const std::vector<DeviceArm>& arms) {
  return static_cast<int>(std::ranges::count(arms, device::Part::kTip, &DeviceArm::part));
}

}  // namespace haptrial::protocols
