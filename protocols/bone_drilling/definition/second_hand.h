#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "core/base/definition/schema_forward.h"
#include "core/bone/simulator/second_hand.h"
#include "core/device/device.h"

namespace haptrial::protocols {

/// Use of a second device: a tube that sucks and rinses. Source: Morris 2006, §3.2.8.
struct SecondHandParameters {
  bone::TubeParameters tube;
  std::uint32_t suck{1};   // its buttons, a bit each: any of these
  std::uint32_t rinse{2};  //
  /// Direction of this device's handle, as DrillingParameters::handle.
  Eigen::Vector3d handle{Eigen::Vector3d::UnitY()};
  double force_limit{4.0};  // of what its device is asked for > 0 [N]
};

/// The keys of [second_hand].
const Schema<SecondHandParameters>& second_hand_schema();

/// A reading of a device after the first as the session file keeps it: what is simulated from it
/// is simulated again from the file. Servo thread.
device::DeviceReading second_as_recorded(const device::DeviceReading& reading) noexcept;

}  // namespace haptrial::protocols
