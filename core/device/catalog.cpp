#include "core/device/catalog.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/base/error.h"
#include "core/device/force_dimension.h"
#include "core/device/gamepad.h"
#include "core/device/open_haptics.h"
#include "core/device/registered_devices.h"

namespace haptrial::device {
namespace {

DeviceListing force_dimension(const std::string& library) {
  const char* const name = "force-dimension";
  try {
    const int count = count_force_dimension_devices(library);
    if (count <= 0) {
      return {name, false,
              "the library is installed, but no device answers; check cable and power"};
    }
    return {name, true, fmt::format("{} connected (omega, delta, sigma, Falcon)", count)};
  } catch (const InputError& error) {
    return {name, false, error.what()};
  }
}

DeviceListing open_haptics(const std::string& library) {
  const char* const name = "open-haptics";
  try {
    check_open_haptics_library(library);
    return {name, true,
            "the library is installed (Phantom, Touch); whether a device answers shows when it is "
            "opened"};
  } catch (const InputError& error) {
    return {name, false, error.what()};
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

std::vector<DeviceListing> list_devices(const VendorLibraries& libraries) {
  std::vector<DeviceListing> list{
      {"virtual", true, "simulated 3-DOF impedance device with a virtual subject's hand"},
      {"replay", true, "the hand of a recorded session, played back"},
      {"mouse", true, "the pointer stands for the hand; forces are seen, not felt"},
      gamepad(),
      force_dimension(libraries.force_dimension),
      open_haptics(libraries.open_haptics)};
  for (const RegisteredDevice& device : registered_devices()) {
    list.push_back({device.name, true, device.what});
  }
  return list;
}

}  // namespace haptrial::device
