#pragma once

#include <string>
#include <vector>

#include "core/device/sensed_mount.h"
#include "core/device/virtual_device.h"

namespace haptrial::test {

/// How often intervals held the truth of one figure.
struct CoverageCount {
  std::string figure;
  int held{0};
  int of{0};
};

/// The arm with planted faults: gain 0.87, friction 0.3 N, cogging, 4 ms delay, a resonance and a
/// dead zone.
device::VirtualDeviceParameters faulty_electronics();
device::SensedMountParameters faulty_mount();

/// Certificates of that arm, and which of their 95 % intervals hold the truth.
/// @param first, count  seeds
std::vector<CoverageCount> count_coverage(int first, int count);

}  // namespace haptrial::test
