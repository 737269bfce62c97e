#include <fmt/format.h>

#include "core/device/catalog.h"
#include "experiments/command/sessions/device_commands.h"

namespace haptrial::experiments {

int devices() {
  for (const device::DeviceListing& listing : device::list_devices()) {
    fmt::print("{:<16} {:<8} {}\n", listing.name, listing.available ? "ready" : "missing",
               listing.what);
  }
  return 0;
}

}  // namespace haptrial::experiments
