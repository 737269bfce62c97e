#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace haptrial {
class Table;
}

namespace haptrial::scene {
struct Field;
}

namespace haptrial::protocols {

/// One of several devices of a session.
struct TrialDevice {
  std::string name;                                // as fields and regions name it
  Eigen::Vector3d start{Eigen::Vector3d::Zero()};  // of a virtual participant's hand, in W [m]
};

/// Reads [devices.NAME], each with `start` [m], in the order of the file; without the table there
/// is one device, which needs no name, and the list is empty. Problems are noted.
std::vector<TrialDevice> read_devices(Table& root);

/// The device of a field or region by the name of its table, from 0; those without one are not
/// there.
using DeviceOf = std::map<std::string, std::size_t>;

/// Reads the key `device` of the tables of fields, regions or objects. Problems are noted.
/// @param description  of the key; @param otherwise  device of a table without it
DeviceOf devices_of(Table& tables, const std::vector<TrialDevice>& devices, const char* description,
                    const char* otherwise);

/// Fields that act on each device, a bit each: those without a device act on all.
std::vector<std::uint64_t> felt_by(const std::vector<scene::Field>& fields,
                                   const DeviceOf& device_of,
                                   const std::vector<TrialDevice>& devices);

}  // namespace haptrial::protocols
