#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/base/definition/schema_forward.h"
#include "core/device/force_dimension.h"
#include "core/device/hapi_board.h"
#include "core/device/haply.h"
#include "core/device/open_haptics.h"
#include "core/device/paddle_board.h"

namespace haptrial::device {

/// How the makers' devices are set up; a table that a definition leaves out has its defaults.
struct VendorSetups {
  ForceDimensionParameters force_dimension;
  OpenHapticsParameters open_haptics;
  HaplyParameters haply;
  HapiParameters hapi;
  PaddleParameters paddle;
};

/// A maker's device, as everything that is not its driver knows it. One more device is a member
/// above and an entry of vendor_devices().
struct VendorDevice {
  struct Limits {
    double max_force;            // that its set-up allows [N]
    double workspace_radius;     // likewise [m]
    double max_torque{0.0};      // likewise, of a device that may turn the hand [N·m]
    double max_grip_force{0.0};  // likewise, of one that may have a gripper [N]
  };
  const char* name;    // as --device takes it
  const char* table;   // of a definition or a lab file
  bool takes_library;  // is driven through a library of the maker
  /// Reads the table. Problems are noted there.
  void (*read)(Table& table, VendorSetups& setups);
  Limits (*limits)(const VendorSetups& setups);
  /// Makes its stop button a button like any other, for a check of the device.
  void (*free_stop_button)(VendorSetups& setups);
  /// @param number   of several with this name, from 0
  /// @param rate     of the servo loop [Hz]
  /// @param library  a path in place of the search; empty if takes_library is false
  /// @throws InputError or RunError as the device's constructor does
  std::unique_ptr<Device> (*open)(const VendorSetups& setups, int number, double rate,
                                  const std::string& library);
  bool (*has_buttons)(const VendorSetups& setups);
  /// Over which its driver estimates velocity [s]; 0: the device itself says it.
  double (*velocity_window)(const VendorSetups& setups);
  /// Says what is there, in one line, without opening a device.
  /// @throws InputError or RunError that says what is missing
  std::string (*look)(const std::string& library);
};

/// Every maker's device, in the order of lists.
std::span<const VendorDevice> vendor_devices();

/// Their names, as --device takes them.
std::vector<std::string> vendor_names();

/// The one of this name; null if there is none.
const VendorDevice* vendor_device(const std::string& name);

}  // namespace haptrial::device
