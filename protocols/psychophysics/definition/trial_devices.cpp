#include "protocols/psychophysics/definition/trial_devices.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "core/base/definition/schema.h"
#include "core/device/handle_part.h"
#include "core/device/motor_faults.h"
#include "core/scene/field.h"
#include "protocols/interface/pass.h"

namespace haptrial::protocols {
namespace {

constexpr const char* kStart =
    "Place at which the hand of a virtual participant on this device begins";

const Schema<TrialDevice>& tip_schema() {
  static const auto schema =
      Schema<TrialDevice>()
          .vector("start", &TrialDevice::start, {-1.0, 1.0}, "m", kStart)
          .required()
          .integer("force_delay", &TrialDevice::force_delay, 1, 8,
                   "Ticks from a command to the force that the hand on this device and its parts "
                   "feels")
          .otherwise("from [device]");
  return schema;
}

/// Before the other keys, which are read in the units of a rotation.
const Schema<TrialDevice>& radius_schema() {
  static const auto schema = Schema<TrialDevice>().number(
      "radius", &TrialDevice::radius, {0.001, 0.5}, "m",
      "Distance of the fingers from the axis of a rotation, at which forces, limits and hands are "
      "reckoned");
  return schema;
}

const Schema<TrialDevice>& part_schema() {
  using D = TrialDevice;
  static const auto schema =
      Schema<D>()
          .vector("start", &D::start, {-1.0, 1.0}, "m", kStart)
          .number("handle_mass", &D::handle_mass, {0.001, 10.0}, "kg",
                  "Mass of a bare grip, or moment of inertia of a bare rotation")
          .number("max_force", &D::max_force, {0.0, 100.0, true}, "N",
                  "Greatest grip force or torque")
          .otherwise("from [envelope]")
          .number("max_force_rate", &D::max_force_rate, {10.0, 10'000.0}, "N/s",
                  "Fastest change of the grip force or torque")
          .otherwise("from [envelope]")
          .number("workspace_radius", &D::workspace_radius, {0.0, 20.0, true}, "m",
                  "Opening or angle beyond which all forces are switched off")
          .otherwise("from [envelope]")
          .number("max_speed", &D::max_speed, {0.0, 20.0, true}, "m/s",
                  "Greatest speed of the opening or rotation; above it all forces are switched off")
          .otherwise("from [envelope]")
          .number("max_jump", &D::max_jump, {0.0, 0.1, true}, "m",
                  "Largest change of the opening or angle between two ticks")
          .otherwise("from [envelope]")
          .table("faults", &D::faults, device::motor_faults_schema(),
                 "Faults of the virtual device's motors there, in place of those of [device]");
  return schema;
}

/// The tip that a key names among the devices before; the first, with the problem noted, if it
/// names none.
std::size_t tip_of(Table& table, const char* key, const std::vector<TrialDevice>& before) {
  const std::string name = table.text(key);
  std::vector<std::string> tips;
  for (std::size_t i = 0; i < before.size(); ++i) {
    if (before[i].is_tip()) {
      tips.push_back(fmt::format("\"{}\"", before[i].name));
    }
    if (before[i].is_tip() && before[i].name == name) {
      return i;
    }
  }
  const std::string allowed = fmt::format("{}", fmt::join(tips, ", "));
  table.reject(key, fmt::format("\"{}\"", name),
               tips.empty() ? "a device whose table stands above" : allowed);
  return 0;
}

void describe_parts(const Table& table) {
  table.describe(
      {"rotation_of", "Device whose rotation this is", "the tip of a device of its own", false});
  table.describe({"grip_of", "Device whose grip this is", "the tip of a device of its own", false});
}

TrialDevice read_device(Table& table, const std::string& name,
                        const std::vector<TrialDevice>& before) {
  TrialDevice device{.name = name};
  describe_parts(table);
  if (table.has("rotation_of")) {
    device.part = device::Part::kRotation;
    device.of = tip_of(table, "rotation_of", before);
    radius_schema().read(table, device);
    state_in_units_of(device, table);
    if (table.has("faults")) {
      Table faults = table.table("faults");
      state_in_units_of(device, faults);
    }
  } else if (table.has("grip_of")) {
    device.part = device::Part::kGrip;
    device.of = tip_of(table, "grip_of", before);
  } else {
    device.of = before.size();
    tip_schema().read(table, device);
    return device;
  }
  part_schema().read(table, device);
  return device;
}

/// Two parts of one device that would drive the same motors.
void reject_twins(Table& table, const std::vector<TrialDevice>& devices) {
  for (std::size_t i = 0; i < devices.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (!devices[i].is_tip() && devices[i].part == devices[j].part &&
          devices[i].of == devices[j].of) {
        table.reject(devices[i].name, fmt::format("is the same part of {} as {}; leave out one",
                                                  devices[devices[i].of].name, devices[j].name));
      }
    }
  }
}

}  // namespace

void state_in_units_of(const TrialDevice& device, Table& table) {
  if (device.part == device::Part::kRotation) {
    table.state_in(AngularUnits(device.radius));
  }
}

std::vector<TrialDevice> read_devices(Table& root) {
  std::vector<TrialDevice> devices;
  if (!root.has("devices")) {
    return devices;
  }
  Table table = root.table("devices");
  for (const std::string& name : table.keys_as_written()) {
    Table own = table.table(name);
    devices.push_back(read_device(own, name, devices));
  }
  reject_twins(table, devices);
  if (devices.empty() || devices.size() > kMostDevices) {
    root.reject("devices", fmt::format("{} of them", devices.size()),
                fmt::format("1 to {} tables [devices.NAME]", kMostDevices));
    devices.resize(std::min(devices.size(), kMostDevices));
  }
  return devices;
}

DeviceOf devices_of(Table& tables, const std::vector<TrialDevice>& devices, const char* description,
                    const char* otherwise) {
  std::vector<std::string> known;
  for (const TrialDevice& each : devices) {
    known.push_back(each.name);
  }
  DeviceOf result;
  for (const std::string& name : tables.keys()) {
    Table table = tables.table(name);
    table.describe({"device", description, otherwise, false});
    if (!table.has("device")) {
      continue;
    }
    if (known.empty()) {
      table.reject("device", "names a device, but the definition has no [devices]");
      continue;
    }
    const std::string device = table.choice("device", known);
    const auto at = std::find(known.begin(), known.end(), device);
    result[name] = at == known.end() ? 0 : static_cast<std::size_t>(at - known.begin());
    state_in_units_of(devices[result[name]], table);
  }
  return result;
}

std::vector<DeviceArm> arms_of(const std::vector<TrialDevice>& devices,
                               const device::EnvelopeLimits& envelope) {
  std::vector<DeviceArm> arms;
  for (const TrialDevice& each : devices) {
    DeviceArm arm{envelope, each.name, each.part, each.of};
    if (!each.is_tip()) {
      arm.radius = each.part == device::Part::kRotation ? each.radius : 1.0;
      arm.handle_mass = each.handle_mass;
      arm.faults = each.faults;
      arm.limits.max_force = each.max_force.value_or(envelope.max_force);
      arm.limits.max_force_rate = each.max_force_rate.value_or(envelope.max_force_rate);
      arm.limits.workspace_radius = each.workspace_radius.value_or(envelope.workspace_radius);
      arm.limits.max_speed = each.max_speed.value_or(envelope.max_speed);
      arm.limits.max_jump = each.max_jump.value_or(envelope.max_jump);
    }
    arms.push_back(arm);
  }
  if (arms.empty()) {
    arms.push_back({envelope});
  }
  return arms;
}

std::vector<record::ArmRow> arm_rows(const std::vector<TrialDevice>& devices) {
  std::vector<record::ArmRow> rows;
  if (std::ranges::all_of(devices, &TrialDevice::is_tip)) {
    return rows;
  }
  for (const TrialDevice& each : devices) {
    rows.push_back({static_cast<std::int32_t>(rows.size()), each.name, device::part_word(each.part),
                    static_cast<std::int32_t>(each.of),
                    each.part == device::Part::kRotation ? each.radius : 1.0});
  }
  return rows;
}

std::vector<std::uint64_t> felt_by(const std::vector<scene::Field>& fields,
                                   const DeviceOf& device_of,
                                   const std::vector<TrialDevice>& devices) {
  std::vector<std::uint64_t> felt(std::max<std::size_t>(1, devices.size()), 0);
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const auto own = device_of.find(fields[i].name);
    for (std::size_t device = 0; device < felt.size(); ++device) {
      const bool feels = own == device_of.end() ? devices.empty() || devices[device].is_tip()
                                                : own->second == device;
      felt[device] |= feels ? std::uint64_t{1} << i : 0;
    }
  }
  return felt;
}

}  // namespace haptrial::protocols
