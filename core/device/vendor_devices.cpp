#include "core/device/vendor_devices.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

#include "core/base/definition/schema.h"
#include "core/base/error.h"

namespace haptrial::device {
namespace {

std::string look_for_force_dimension(const std::string& library) {
  const int count = count_force_dimension_devices(library);
  if (count <= 0) {
    throw RunError("the library is installed, but no device answers; check cable and power");
  }
  return fmt::format("{} connected (omega, delta, sigma, Falcon)", count);
}

std::string look_for_open_haptics(const std::string& library) {
  check_open_haptics_library(library);
  return "the library is installed (Phantom, Touch); whether a device answers shows when it is "
         "opened";
}

std::string look_for_haply(const std::string& /*library*/) {
  const HaplyService service = find_haply_service(HaplyParameters{}.port);
  const std::size_t count = service.inventory.devices.size();
  if (count == 0) {
    throw RunError("the Inverse Service answers, but lists no device; check cable and power");
  }
  return fmt::format("{} connected (Inverse3, Inverse3x, Minverse)", count);
}

/// The serial lines on which a board may be.
std::string look_for_boards(const std::string& /*library*/) {
  const std::vector<std::string> found = find_serial_lines();
  if (found.empty()) {
    throw RunError("no serial line is connected (/dev/serial/by-id has none)");
  }
  return fmt::format("port of its table is one of: {}", fmt::join(found, ", "));
}

/// A board has the serial line that its table names, and no other.
void check_line(const char* table, const SerialBoardSetup& line, int number) {
  if (line.port.empty()) {
    throw InputError(
        fmt::format("device {0}: needs a definition or lab file with a table [{0}] whose port says "
                    "which serial line that is; /dev/serial/by-id names what is connected",
                    table));
  }
  if (number > 0) {
    throw InputError(
        fmt::format("{}: is asked for twice, but [{}] has the port of one board", table, table));
  }
}

bool always(const VendorSetups& /*setups*/) { return true; }
double says_velocity(const VendorSetups& /*setups*/) { return 0.0; }

/// An entry of a device that is opened from its set-up, the rate and a library.
template <auto member, auto schema>
void read_table(Table& table, VendorSetups& setups) {
  schema().read(table, setups.*member);
}
template <auto member>
VendorDevice::Limits limits_of(const VendorSetups& setups) {
  const auto& setup = setups.*member;
  VendorDevice::Limits limits{setup.max_force, setup.workspace_radius};
  if constexpr (requires { setup.max_torque; }) {
    limits.max_torque = setup.max_torque;
  }
  if constexpr (requires { setup.max_grip_force; }) {
    limits.max_grip_force = setup.max_grip_force;
  }
  return limits;
}
template <auto member>
VendorDevice::Limits limits_of_board(const VendorSetups& setups) {
  return {(setups.*member).line.max_force, (setups.*member).line.workspace_radius};
}
template <auto member>
void without_stop_button(VendorSetups& setups) {
  (setups.*member).stop_button = -1;
}

using S = VendorSetups;

constexpr std::array kDevices{
    VendorDevice{"force-dimension", "force_dimension", true,
                 read_table<&S::force_dimension, force_dimension_schema>,
                 limits_of<&S::force_dimension>, without_stop_button<&S::force_dimension>,
                 [](const S& setups, int number, double rate,
                    const std::string& library) -> std::unique_ptr<Device> {
                   ForceDimensionParameters parameters = setups.force_dimension;
                   parameters.index += number;
                   return std::make_unique<ForceDimensionDevice>(parameters, rate, library);
                 },
                 always, [](const S& s) { return s.force_dimension.velocity_window; },
                 look_for_force_dimension},
    VendorDevice{"open-haptics", "open_haptics", true,
                 read_table<&S::open_haptics, open_haptics_schema>, limits_of<&S::open_haptics>,
                 without_stop_button<&S::open_haptics>,
                 [](const S& setups, int /*number*/, double rate,
                    const std::string& library) -> std::unique_ptr<Device> {
                   return std::make_unique<OpenHapticsDevice>(setups.open_haptics, rate, library);
                 },
                 always, says_velocity, look_for_open_haptics},
    VendorDevice{"haply", "haply", false, read_table<&S::haply, haply_schema>, limits_of<&S::haply>,
                 without_stop_button<&S::haply>,
                 [](const S& setups, int number, double rate,
                    const std::string& /*library*/) -> std::unique_ptr<Device> {
                   return std::make_unique<HaplyDevice>(setups.haply, rate, number);
                 },
                 always, says_velocity, look_for_haply},
    VendorDevice{"hapi", "hapi", false, read_table<&S::hapi, hapi_schema>,
                 limits_of_board<&S::hapi>, [](S& /*setups*/) {},
                 [](const S& setups, int number, double rate,
                    const std::string& /*library*/) -> std::unique_ptr<Device> {
                   check_line("hapi", setups.hapi.line, number);
                   return open_hapi_board(setups.hapi, rate);
                 },
                 [](const S& /*setups*/) { return false; },
                 [](const S& s) { return s.hapi.line.velocity_window; }, look_for_boards},
    VendorDevice{"paddle", "paddle", false, read_table<&S::paddle, paddle_schema>,
                 limits_of_board<&S::paddle>, without_stop_button<&S::paddle>,
                 [](const S& setups, int number, double rate,
                    const std::string& /*library*/) -> std::unique_ptr<Device> {
                   check_line("paddle", setups.paddle.line, number);
                   return open_paddle_board(setups.paddle, rate);
                 },
                 [](const S& setups) { return has_buttons(setups.paddle); },
                 [](const S& s) { return s.paddle.line.velocity_window; }, look_for_boards},
};

}  // namespace

std::span<const VendorDevice> vendor_devices() { return kDevices; }

std::vector<std::string> vendor_names() {
  std::vector<std::string> names;
  for (const VendorDevice& each : kDevices) {
    names.emplace_back(each.name);
  }
  return names;
}

const VendorDevice* vendor_device(const std::string& name) {
  const auto* const found =
      std::find_if(kDevices.begin(), kDevices.end(),
                   [&](const VendorDevice& each) { return name == each.name; });
  return found != kDevices.end() ? found : nullptr;
}

}  // namespace haptrial::device
