#pragma once

#include <string>

namespace haptrial::experiments {

// Each subcommand prints to standard output and returns an exit status. Bad input and failures come
// as InputError and RunError.

int devices();

struct DeviceTestOptions {
  std::string name;
  std::string definition;  // whose set-up of the device is used; empty: the driver's defaults
  double seconds{120.0};
  std::string library;  // a path in place of the search for the vendor's library
};
/// @returns 0 when the device is fit for use, else 1.
int device_test(const DeviceTestOptions& options);

}  // namespace haptrial::experiments
