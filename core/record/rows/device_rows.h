#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>

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

/// A part of a device that the session drives, a row of /arms. Those of a rotation are recorded as
/// the arc that fingers travel which hold it at `radius`, and the force along it.
struct ArmRow {
  std::int32_t device{0};  // as in /devices; 0 is that of /samples
  std::string name;        // in the definition
  std::string part;        // "tip", "rotation" or "grip"
  std::int32_t of{0};      // the device whose part it is, as above
  double radius{1.0};      // of a rotation [m]
};

/// The table exists in sessions that drive a rotation or a grip.
template <>
const Table<ArmRow>& table_of<ArmRow>();

/// The cursor on one tick, a row of /cursor, where it moves otherwise than the tool.
struct CursorRow {
  std::uint64_t sequence{0};                       // of the tick, as in /samples
  Eigen::Vector3d place{Eigen::Vector3d::Zero()};  // in W [m]
  bool shown{false};
};

template <>
const Table<CursorRow>& table_of<CursorRow>();

/// A moving target on one tick on which a stage shows it, a row of /targets.
struct TargetRow {
  std::uint64_t sequence{0};                       // of the tick, as in /samples
  std::int32_t target{0};                          // of [targets] in the order of names, from 0
  Eigen::Vector3d place{Eigen::Vector3d::Zero()};  // in W [m]
};

template <>
const Table<TargetRow>& table_of<TargetRow>();

}  // namespace haptrial::record
