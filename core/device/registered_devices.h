#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/device/device.h"

namespace haptrial::device {

/// A device that is driven from outside of the program. --device NAME opens it, or NAME:SETTING.
struct RegisteredDevice {
  std::string name;  // letters, digits and '-'
  std::string what;  // one line for the list of devices
  /// @param setting  what stands behind the colon; may be empty
  /// @param number   of several with this name, from 0
  /// @param rate     of the servo loop [Hz]
  /// @throws InputError for a setting that is not allowed, RunError if no device answers
  std::unique_ptr<Device> (*open)(const std::string& setting, int number, double rate){nullptr};
};

/// Added devices in the order in which they were added. Call before threads are started.
const std::vector<RegisteredDevice>& registered_devices();
/// @throws std::invalid_argument for a name that is taken or has other characters
void register_device(const RegisteredDevice& device);
/// Names that --device takes without a file: the program's own devices, then added ones.
std::vector<std::string> device_names();
/// The one that NAME or NAME:SETTING asks for; null if there is none.
const RegisteredDevice* registered_device(const std::string& choice);
/// SETTING of NAME:SETTING; empty without one.
std::string setting_of(const std::string& choice);

}  // namespace haptrial::device
