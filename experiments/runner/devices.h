#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "protocols/definition/definition.h"
#include "protocols/interface/rig.h"

namespace haptrial::experiments {

/// Which device, and where its vendor's library is.
struct DeviceChoice {
  std::string name{"virtual"};  // or another of device_names(), or replay:FILE
  std::string library{};        // a path in place of the search
  int number{0};                // of several with this name, from 0: added to their index
};

/// The choice of a device after its place in the definition, from 0: those without one have the
/// last, with the next number.
DeviceChoice choice_of(const std::vector<DeviceChoice>& choices, std::size_t device);

/// Event of a session with several devices: their names in their order, "haply, paddle".
inline constexpr const char* kDevicesEvent = "devices";
std::string devices_text(const std::vector<DeviceChoice>& choices, int devices);
std::vector<std::string> devices_in(const std::string& text);

/// Opens the devices of a session, set up as the definition says; replay:FILE plays a recorded
/// session's hand back.
/// @param choices      of each device in their order; for those that it leaves out the last one
/// @param virtual_rig  makes virtual devices with a virtual person
/// @throws InputError for an unknown name, an absent library, an envelope that the device cannot
///         fill, or a mouse or gamepad that is not the first device; RunError where no device
///         answers.
std::unique_ptr<protocols::Rig> make_rig(
    const std::vector<DeviceChoice>& choices, const protocols::Definition& definition,
    const std::function<std::unique_ptr<protocols::Rig>()>& virtual_rig);

/// @throws InputError unless make_rig knows the name.
void check_device_name(const std::string& name);

/// @throws InputError for a library that this device has no use for.
void check_library(const std::string& device, const std::string& library);

/// Whether it is driven through a vendor's library.
bool takes_library(const std::string& device);

/// FILE of replay:FILE; nothing for any other device.
std::optional<std::string> replayed_file(const std::string& device);

}  // namespace haptrial::experiments
