#include "core/device/axis_names.h"

#include <fmt/format.h>
#include <linux/input.h>

#include <algorithm>
#include <array>
#include <utility>

namespace haptrial::device {
namespace {

constexpr std::array<std::pair<const char*, int>, 19> kAxes{{{"ABS_X", ABS_X},
                                                             {"ABS_Y", ABS_Y},
                                                             {"ABS_Z", ABS_Z},
                                                             {"ABS_RX", ABS_RX},
                                                             {"ABS_RY", ABS_RY},
                                                             {"ABS_RZ", ABS_RZ},
                                                             {"ABS_GAS", ABS_GAS},
                                                             {"ABS_BRAKE", ABS_BRAKE},
                                                             {"ABS_WHEEL", ABS_WHEEL},
                                                             {"ABS_RUDDER", ABS_RUDDER},
                                                             {"ABS_HAT0X", ABS_HAT0X},
                                                             {"ABS_HAT0Y", ABS_HAT0Y},
                                                             {"ABS_HAT1X", ABS_HAT1X},
                                                             {"ABS_HAT1Y", ABS_HAT1Y},
                                                             {"ABS_HAT2X", ABS_HAT2X},
                                                             {"ABS_HAT2Y", ABS_HAT2Y},
                                                             {"ABS_MISC", ABS_MISC},
                                                             {"ABS_PRESSURE", ABS_PRESSURE},
                                                             {"ABS_THROTTLE", ABS_THROTTLE}}};

}  // namespace

const std::vector<std::string>& axis_names() {
  static const std::vector<std::string> kNames = [] {
    std::vector<std::string> names;
    for (const auto& axis : kAxes) {
      names.emplace_back(axis.first);
    }
    return names;
  }();
  return kNames;
}

int axis_of(const std::string& name) {
  const auto* found = std::find_if(kAxes.begin(), kAxes.end(),
                                   [&name](const auto& axis) { return name == axis.first; });
  return found == kAxes.end() ? -1 : found->second;
}

std::string axis_name(int axis) {
  const auto* found = std::find_if(kAxes.begin(), kAxes.end(),
                                   [axis](const auto& each) { return axis == each.second; });
  return found == kAxes.end() ? fmt::format("axis {}", axis) : found->first;
}

}  // namespace haptrial::device
