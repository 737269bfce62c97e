#include "protocols/definition/handle_loop.h"

#include <algorithm>
#include <cmath>

#include "core/base/definition/table.h"
#include "protocols/definition/definition.h"

namespace haptrial::protocols {

control::HandleLoop handle_loop(const Definition& d) {
  control::HandleLoop loop;
  loop.handle_mass = d.hand.handle_mass;
  loop.rate = d.rate;
  loop.force_delay = d.device.force_delay;
  loop.velocity_window = device::readings_in_window(d.device.velocity_window, d.rate);
  for (const device::VendorDevice& vendor : device::vendor_devices()) {
    // A board is driven only if the definition has its table, which names its line.
    const bool stated = d.document != nullptr && d.root().has(vendor.table);
    if (vendor.takes_library || stated) {
      const auto readings =
          static_cast<int>(std::lround(vendor.velocity_window(d.vendor) * d.rate));
      loop.velocity_window = std::max(loop.velocity_window, readings);
    }
  }
  return loop;
}

}  // namespace haptrial::protocols
