#include "protocols/definition/handle_loop.h"

#include <algorithm>
#include <cmath>

#include "protocols/definition/definition.h"

namespace haptrial::protocols {

control::HandleLoop handle_loop(const Definition& d) {
  control::HandleLoop loop;
  loop.handle_mass = d.hand.handle_mass;
  loop.rate = d.rate;
  loop.force_delay = d.device.force_delay;
  loop.velocity_window =
      std::max({device::readings_in_window(d.device.velocity_window, d.rate),
                static_cast<int>(std::lround(d.vendor.force_dimension.velocity_window * d.rate))});
  return loop;
}

}  // namespace haptrial::protocols
