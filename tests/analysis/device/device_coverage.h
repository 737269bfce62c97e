#pragma once

#include <string>
#include <vector>

#include "analysis/device/excitation.h"
#include "core/device/device.h"
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

/// A part of a handle with planted faults, as it is at the fingers.
struct FaultyPart {
  device::VirtualDeviceParameters electronics;
  device::SensedMountParameters mount;
  double max_force;  // that is commanded [N]
  analysis::DrivenAxes axes;
  double reach;  // to either side [m]
};

/// The tip of that arm; a rotation about three axes, 0.02 m from the fingers, with the gain 0.92,
/// friction of 4 mN·m and 20 mg·m², which is 0.05 kg at the fingers; or a grip with the gain 0.8
/// and friction of 0.25 N.
FaultyPart faulty_part(device::Part of);

/// Certificates of such a part, and which of their 95 % intervals hold the truth.
/// @param first, count  seeds
std::vector<CoverageCount> count_coverage(const FaultyPart& part, int first, int count);

/// Certificates from motion alone, without a sensor, of parts whose faults are drawn at random:
/// motion has no noise but the encoders', so that equal faults would give equal figures.
std::vector<CoverageCount> count_free_coverage(device::Part of, int first, int count);

}  // namespace haptrial::test
