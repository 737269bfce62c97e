#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/base/definition/schema_forward.h"
#include "core/record/rows/device_rows.h"
#include "protocols/definition/definition.h"

namespace haptrial::scene {
struct Field;
}

namespace haptrial::protocols {

/// One of several devices of a session, or a rotation or grip of one before it: a place with a
/// velocity and a force at the fingers, as a tip has (core/device/handle_part.h).
struct TrialDevice {
  std::string name;                                // as fields and regions name it
  Eigen::Vector3d start{Eigen::Vector3d::Zero()};  // of a virtual participant's hand, in W [m]
  device::Part part{device::Part::kTip};
  std::size_t of{0};                 // the device whose part it is, from 0
  double radius{0.03};               // of the fingers about the axis of a rotation > 0 [m]
  double handle_mass{0.05};          // of a bare rotation or grip, at the fingers [kg]
  std::optional<int> force_delay{};  // of a tip, in place of that of [device] [ticks]
  // In place of those of [envelope], for a rotation or grip.
  std::optional<double> max_force{};         // [N]
  std::optional<double> max_force_rate{};    // [N/s]
  std::optional<double> workspace_radius{};  // [m]
  std::optional<double> max_speed{};         // [m/s]
  std::optional<double> max_jump{};          // [m]
  // In place of those of [device], for a rotation or grip.
  std::optional<device::MotorFaults> faults{};

  bool is_tip() const { return part == device::Part::kTip; }
};

/// Reads [devices.NAME] in the order of the file: of a device `start` [m]; of a rotation
/// (`rotation_of`) in rad and N·m and of a grip (`grip_of`) also what bounds it. Without the table
/// there is one device, which needs no name, and the list is empty. Problems are noted.
std::vector<TrialDevice> read_devices(Table& root);

/// The parts that sessions drive. @param envelope  of every tip, and of a part what it does not
/// state
std::vector<DeviceArm> arms_of(const std::vector<TrialDevice>& devices,
                               const device::EnvelopeLimits& envelope);

/// The rows of /arms; none where every device is only its tip.
std::vector<record::ArmRow> arm_rows(const std::vector<TrialDevice>& devices);

/// The device of a field or region by the name of its table, from 0; those without one are not
/// there.
using DeviceOf = std::map<std::string, std::size_t>;

/// Reads the key `device` of the tables of fields, regions or objects; those of a rotation are then
/// read in angular units (Table::state_in). Problems are noted.
/// @param description  of the key; @param otherwise  device of a table without it
DeviceOf devices_of(Table& tables, const std::vector<TrialDevice>& devices, const char* description,
                    const char* otherwise);

/// Reads what is stated of this device in its own units. @param table  of it
void state_in_units_of(const TrialDevice& device, Table& table);

/// Fields that act on each device, a bit each: those without a device act on every tip.
std::vector<std::uint64_t> felt_by(const std::vector<scene::Field>& fields,
                                   const DeviceOf& device_of,
                                   const std::vector<TrialDevice>& devices);

}  // namespace haptrial::protocols
