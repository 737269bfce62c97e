#pragma once

#include <map>
#include <string>
#include <vector>

namespace haptrial::device {

/// A device that the program knows.
struct DeviceListing {
  std::string name;  // as --device takes it
  bool available{false};
  std::string what;  // one line: what it is, or what is missing and where to get it
};

/// Every device, those that are always there first. Loads the makers' libraries, or asks their
/// services, for as long as it takes; opens no device.
/// @param libraries  paths in place of the search for a device's library
std::vector<DeviceListing> list_devices(const std::map<std::string, std::string>& libraries = {});

}  // namespace haptrial::device
