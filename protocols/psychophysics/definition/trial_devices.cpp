#include "protocols/psychophysics/definition/trial_devices.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/definition/schema.h"
#include "core/scene/field.h"
#include "protocols/interface/pass.h"

namespace haptrial::protocols {
namespace {

const Schema<TrialDevice>& device_schema() {
  using D = TrialDevice;
  static const auto schema =
      Schema<D>()
          .vector("start", &D::start, {-1.0, 1.0}, "m",
                  "Place at which the hand of a virtual participant on this device begins")
          .required();
  return schema;
}

}  // namespace

std::vector<TrialDevice> read_devices(Table& root) {
  std::vector<TrialDevice> devices;
  if (!root.has("devices")) {
    return devices;
  }
  Table table = root.table("devices");
  for (const std::string& name : table.keys_as_written()) {
    Table device = table.table(name);
    devices.push_back({name, {}});
    device_schema().read(device, devices.back());
  }
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
  }
  return result;
}

std::vector<std::uint64_t> felt_by(const std::vector<scene::Field>& fields,
                                   const DeviceOf& device_of,
                                   const std::vector<TrialDevice>& devices) {
  std::vector<std::uint64_t> felt(std::max<std::size_t>(1, devices.size()), 0);
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const auto own = device_of.find(fields[i].name);
    for (std::size_t device = 0; device < felt.size(); ++device) {
      const bool feels = own == device_of.end() || own->second == device;
      felt[device] |= feels ? std::uint64_t{1} << i : 0;
    }
  }
  return felt;
}

}  // namespace haptrial::protocols
