#include "core/device/catalog.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/base/error.h"
#include "core/device/gamepad.h"
#include "core/device/registered_devices.h"
#include "core/device/vendor_devices.h"

namespace haptrial::device {
namespace {

DeviceListing listing_of(const VendorDevice& device, const std::string& library) {
  try {
    return {device.name, true, device.look(library)};
  } catch (const InputError& error) {
    return {device.name, false, error.what()};
  } catch (const RunError& error) {
    return {device.name, false, error.what()};
  }
}

DeviceListing gamepad() {
  const std::vector<std::string> found = find_gamepads();
  if (found.empty()) {
    return {"gamepad", false,
            "no game controller is connected (/dev/input/by-id has none); [gamepad] of a "
            "definition may name a pipe instead"};
  }
  return {"gamepad", true,
          fmt::format("a game controller moves the mouse's hand; [gamepad] names it: {}",
                      fmt::join(found, ", "))};
}

}  // namespace

std::vector<DeviceListing> list_devices(const std::map<std::string, std::string>& libraries) {
  std::vector<DeviceListing> list{
      {"virtual", true, "simulated 3-DOF impedance device with a virtual subject's hand"},
      {"replay", true, "the hand of a recorded session, played back"},
      {"mouse", true, "the pointer stands for the hand; forces are seen, not felt"},
      gamepad()};
  for (const VendorDevice& device : vendor_devices()) {
    const auto library = libraries.find(device.name);
    list.push_back(listing_of(device, library != libraries.end() ? library->second : ""));
  }
  for (const RegisteredDevice& device : registered_devices()) {
    list.push_back({device.name, true, device.what});
  }
  return list;
}

}  // namespace haptrial::device
