#include "protocols/bone_drilling/definition/controls.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/definition/schema.h"
#include "protocols/definition/window_keys.h"

namespace haptrial::protocols {

namespace {

/// Purposes of buttons and keys, by function.
constexpr std::array<const char*, bone::kFunctions> kPurposes{
    "that turn the burr, or let the suction suck, while held",
    "that take the next tool",
    "that take the tool before",
    "that let the hand move the camera while held",
    "that let the hand turn the camera while held",
    "that make the picture larger while held",
    "that make the picture smaller while held",
    "that let the touched piece of bone go with the hand while held",
    "that fix the plate or cut the plane",
    "that take off the plate that was fixed last",
    "that end the procedure",
    "that show the next still",
    "that make burrs turn the other way"};

/// @param things  "Buttons of the device"  @param read  a function's, by its number
template <class Read>
Schema<Controls> functions_schema(const char* things, const char* pedal, Read read) {
  Schema<Controls> schema;
  for (std::size_t f = 0; f < bone::kFunctions; ++f) {
    schema
        .custom(std::string(bone::name_of(static_cast<bone::Function>(f))),
                fmt::format("{} {}", things, kPurposes[f]),
                [read, f](Table& table, const std::string& key, Controls& controls) {
                  read(table, key, controls, f);
                })
        .otherwise("none");
  }
  schema.flag("analog_pedal", &Controls::analog_power, pedal).otherwise("false");
  return schema;
}

const Schema<Controls>& buttons_schema() {
  static const auto schema = functions_schema(
      "Buttons of the device", "Whether the depth of a pedal sets the speed of the burr",
      [](Table& table, const std::string& key, Controls& controls, std::size_t f) {
        controls.buttons[f] = read_bits(table, key);
      });
  return schema;
}

const Schema<Controls>& keys_schema() {
  static const auto schema = functions_schema(
      "Keys of the window",
      "Whether the depth of a pedal sets the speed of the burr; counts before the value in "
      "[buttons]",
      [](Table& table, const std::string& key, Controls& controls, std::size_t f) {
        controls.keys[f] = read_window_keys(table, key);
      });
  return schema;
}

}  // namespace

Controls read_controls(Table& root) {
  Controls controls;
  if (root.has("buttons")) {
    Table table = root.table("buttons");
    buttons_schema().read(table, controls);
  }
  if (root.has("keys")) {
    Table table = root.table("keys");
    keys_schema().read(table, controls);
  }
  return controls;
}

std::uint32_t functions_of(const Controls& controls,
                           const device::DeviceReading& reading) noexcept {
  std::uint32_t functions = reading.keys;
  for (std::size_t f = 0; f < bone::kFunctions; ++f) {
    if ((controls.buttons[f] & reading.buttons) != 0) {
      functions |= std::uint32_t{1} << f;
    }
  }
  return functions;
}

double power_of(const Controls& controls, const device::DeviceReading& reading,
                std::uint32_t functions) noexcept {
  if (controls.analog_power && reading.pedal > 0.0) {
    return std::min(1.0, reading.pedal);
  }
  return (functions & bone::bit(bone::Function::kPower)) != 0 ? 1.0 : 0.0;
}

std::uint32_t functions_of_keys(const Controls& controls, const std::vector<int>& held) {
  std::uint32_t functions = 0;
  for (std::size_t f = 0; f < bone::kFunctions; ++f) {
    for (const int key : controls.keys[f]) {
      if (std::find(held.begin(), held.end(), key) != held.end()) {
        functions |= std::uint32_t{1} << f;
      }
    }
  }
  return functions;
}

}  // namespace haptrial::protocols
