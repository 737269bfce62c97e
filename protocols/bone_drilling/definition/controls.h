#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/base/definition/schema_forward.h"
#include "core/bone/simulator/simulator.h"
#include "core/device/device.h"

namespace haptrial::protocols {

/// Functions of a device's buttons, the window's keys and pedals. A USB pedal is a keyboard with
/// few keys. Source: Morris 2006, §8.2.2.
struct Controls {
  std::array<std::uint32_t, bone::kFunctions> buttons{};  // by function: any of these, a bit each
  std::array<std::vector<int>, bone::kFunctions> keys{};  // by function: codes of the window
  bool analog_power{false};                               // the pedal's depth is the power
};

/// Reads a [buttons] table, whose keys are functions and whose values are lists of button numbers
/// from 0, a [keys] table with lists of key names ("space", "enter", "A" to "Z", "0" to "9"), and
/// `analog_pedal` of [buttons]. Both tables may be left out of `root`.
Controls read_controls(Table& root);

/// The functions that a reading holds, its `keys` among them: bits of bone::bit().
std::uint32_t functions_of(const Controls& controls, const device::DeviceReading& reading) noexcept;
/// The power of the tool, 0 to 1: the pedal's depth where it is analog and down, else whether
/// kPower is held.
double power_of(const Controls& controls, const device::DeviceReading& reading,
                std::uint32_t functions) noexcept;
/// The functions that the held keys of a window stand for.
std::uint32_t functions_of_keys(const Controls& controls, const std::vector<int>& held);

}  // namespace haptrial::protocols
