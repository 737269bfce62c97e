#pragma once

#include <string>
#include <vector>

namespace haptrial::device {

/// A device that the program knows.
struct DeviceListing {
  std::string name;  // as --device takes it
  bool available{false};
  std::string what;  // one line: what it is, or what is missing and where to get it
};

/// Paths in place of the search for the vendors' libraries; empty: search.
struct VendorLibraries {
  std::string force_dimension;
  std::string open_haptics;
};

/// Every device, those that are always there first. Loads the vendors' libraries for as long as it
/// takes; opens no device.
std::vector<DeviceListing> list_devices(const VendorLibraries& libraries = {});

}  // namespace haptrial::device
