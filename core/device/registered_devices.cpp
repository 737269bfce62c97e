#include "core/device/registered_devices.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <stdexcept>

#include "core/device/vendor_devices.h"

namespace haptrial::device {
namespace {

constexpr std::array kBuiltIn{"virtual", "mouse", "gamepad"};
constexpr const char* kReplay = "replay";  // with a file

std::vector<RegisteredDevice>& all_registered() {
  static std::vector<RegisteredDevice> devices;
  return devices;
}

bool is_word(const std::string& name) {
  return !name.empty() && std::all_of(name.begin(), name.end(), [](unsigned char each) {
    return std::isalnum(each) != 0 || each == '-';
  });
}

}  // namespace

const std::vector<RegisteredDevice>& registered_devices() { return all_registered(); }

void register_device(const RegisteredDevice& device) {
  if (!is_word(device.name)) {
    throw std::invalid_argument(fmt::format(
        "register_device: '{}' is no name; allowed: letters, digits and '-'", device.name));
  }
  const std::vector<std::string> taken = device_names();
  if (device.name == kReplay || std::find(taken.begin(), taken.end(), device.name) != taken.end()) {
    throw std::invalid_argument(
        fmt::format("register_device: there is a device '{}' already", device.name));
  }
  all_registered().push_back(device);
}

std::vector<std::string> device_names() {
  std::vector<std::string> names(kBuiltIn.begin(), kBuiltIn.end());
  const std::vector<std::string> vendors = vendor_names();
  names.insert(names.end(), vendors.begin(), vendors.end());
  for (const RegisteredDevice& each : all_registered()) {
    names.push_back(each.name);
  }
  return names;
}

const RegisteredDevice* registered_device(const std::string& choice) {
  const std::string name = choice.substr(0, choice.find(':'));
  const auto found =
      std::find_if(all_registered().begin(), all_registered().end(),
                   [&](const RegisteredDevice& device) { return device.name == name; });
  return found != all_registered().end() ? &*found : nullptr;
}

std::string setting_of(const std::string& choice) {
  const std::size_t colon = choice.find(':');
  return colon == std::string::npos ? "" : choice.substr(colon + 1);
}

}  // namespace haptrial::device
