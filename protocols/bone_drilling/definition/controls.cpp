#include "protocols/bone_drilling/definition/controls.h"

#include <algorithm>

#include "core/base/definition/table.h"
#include "core/base/definition/table_vector.h"
#include "protocols/definition/window_keys.h"

namespace haptrial::protocols {

Controls read_controls(Table& root) {
  Controls controls;
  const auto each = [&](const char* name, auto read) {
    if (!root.has(name)) {
      return;
    }
    Table table = root.table(name);
    for (std::size_t f = 0; f < bone::kFunctions; ++f) {
      const std::string key(bone::name_of(static_cast<bone::Function>(f)));
      if (table.has(key)) {
        read(table, key, f);
      }
    }
    if (table.has("analog_pedal")) {
      controls.analog_power = table.boolean("analog_pedal");
    }
  };
  each("buttons", [&](Table& table, const std::string& key, std::size_t f) {
    controls.buttons[f] = read_bits(table, key);
  });
  each("keys", [&](Table& table, const std::string& key, std::size_t f) {
    controls.keys[f] = read_window_keys(table, key);
  });
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
