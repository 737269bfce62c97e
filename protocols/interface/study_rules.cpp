#include "protocols/interface/study_rules.h"

#include "core/device/vendor_devices.h"
#include "protocols/interface/protocol.h"

namespace haptrial::protocols {
namespace {

constexpr std::string_view kVirtualDevice = "virtual";

/// Keys of every study that may differ: participants' texts and display, and how many are to come;
/// targets of markers and sounds; questions to the data, and what its plan states.
DefinitionRules of_every_study() {
  DefinitionRules rules;
  rules.free = {"texts",
                "lab",
                "room",
                "screen",
                "certificate",
                "device.certificate",
                "mouse",
                "gamepad",
                "pedal",
                "actuators",
                "channels",
                "markers.serial",
                "markers.baud",
                "markers.neon",
                "markers.pulse",
                "sounds.device",
                "power",
                "plan",
                "curriculum",
                "design.participants",
                "analysis.planned",
                "analysis.reference"};
  for (const device::VendorDevice& vendor : device::vendor_devices()) {
    rules.free.emplace_back(vendor.table);
  }
  // Measures and conditions are in these units; a sensor may be left out or take another's place.
  rules.kept = {"channels.*.quantities", "channels.*.inputs.*.unit"};
  rules.ordered = {"groups"};  // the first participants belong to the first group
  return rules;
}

/// Keys that a person's session leaves unused: the virtual device, its hand and virtual
/// participants.
DefinitionRules of_people(const Protocol& protocol) {
  DefinitionRules rules{.free = {"device", "hand"}};
  const std::vector<std::string> tables = protocol.virtual_tables();
  rules.free.insert(rules.free.end(), tables.begin(), tables.end());
  return rules;
}

/// Values that every device's guidance reckons with: the damping that is felt and the envelope's
/// holding force (read_common()) follow from them.
std::vector<BoundKey> felt_with_every_device() {
  return {{"device.velocity_window"},
          {"device.force_delay", "1"},
          {"force_dimension.velocity_window", "0.008"},
          {"hapi.velocity_window", "0.01"},
          {"paddle.velocity_window", "0.01"},
          {"hand.handle_mass"},
          {"hand.coulomb_friction"}};
}

}  // namespace

DefinitionRules study_rules(const Protocol& protocol, Hand hand) {
  DefinitionRules rules = of_every_study();
  if (hand == Hand::kPerson) {
    rules.add(of_people(protocol));
  }
  rules.bound = felt_with_every_device();
  return rules;
}

DefinitionChanges study_changes(const Protocol& protocol, const record::SessionInfo& before,
                                std::string_view definition, std::string_view device) {
  const bool virtual_hand = before.device == kVirtualDevice || device == kVirtualDevice;
  return definition_changes(before.definition, definition,
                            study_rules(protocol, virtual_hand ? Hand::kVirtual : Hand::kPerson));
}

DefinitionChanges study_changes(const Protocol& protocol, const record::SessionInfo& before,
                                const record::SessionInfo& after) {
  return study_changes(protocol, before, after.definition, after.device);
}

}  // namespace haptrial::protocols
