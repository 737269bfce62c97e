#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "core/record/table/table.h"

namespace haptrial::record {

/// One tick of a device after the first, a row of /devices. The first device is in /samples.
struct DeviceRow {
  std::uint64_t sequence{0};                          // of the tick, as in /samples
  std::int32_t device{1};                             // from 1; 0 is that of /samples
  Eigen::Vector3d position{Eigen::Vector3d::Zero()};  // p_W [m]
  Eigen::Vector3d velocity{Eigen::Vector3d::Zero()};  // v_W [m/s]
  Eigen::Vector3d force{Eigen::Vector3d::Zero()};     // commanded to the device, in W [N]
  std::int32_t buttons{0};                            // bit i: button i is pressed
};

/// The table exists in sessions with several devices.
template <>
const Table<DeviceRow>& table_of<DeviceRow>();

}  // namespace haptrial::record
