#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/point_state.h"

namespace haptrial::device {

/// Reasons for which a state of Haply's Inverse Service is not to be used, or gives no force.
enum class HaplyFault : std::uint8_t {
  kNone,
  kMalformed,      // no JSON, a missing field, a number that is not finite
  kDeviceMissing,  // the service no longer lists the device
  kGripMissing,    // nor the grip
  kClosed,         // the connection ended
  kSilent,         // no state came for too long
  kNotCalibrated,  // these two leave the device answering, but without force
  kNoPower,
};

/// @returns a sentence of static duration; "" for kNone
const char* describe(HaplyFault fault) noexcept;

/// A device or a grip as the service lists it.
struct HaplyListing {
  std::string id;
  std::string type;        // inverse3, inverse3x, minverse; empty: the service does not say
  std::string handedness;  // left or right; empty: the service does not say
  bool plain_axes{true};   // positions are in the device's own axes, in metres
};

/// The first message of the service.
struct HaplyInventory {
  std::vector<HaplyListing> devices;
  std::vector<HaplyListing> grips;
};

/// @returns nothing if the text is no inventory
std::optional<HaplyInventory> read_haply_inventory(std::string_view text);

/// One state of the service, in its own axes and from its own origin.
struct HaplyState {
  PointState cursor;                                               // [m], [m/s]
  Eigen::Quaterniond orientation{Eigen::Quaterniond::Identity()};  // of the grip
  std::uint32_t buttons{0};                                        // a, b, c: bits 0, 1, 2
  HaplyFault fault{HaplyFault::kNone};                             // else nothing is read
  HaplyFault status{HaplyFault::kNone};  // kNotCalibrated, kNoPower, or all is well
};

/// Reads one device and one grip of a state; what it does not find there is a fault.
/// @param grip    empty: no grip is read
/// @param before  the state before this one; a state that leaves the status out keeps it
HaplyState read_haply_state(std::string_view text, const std::string& device,
                            const std::string& grip, const HaplyState& before);

/// Writes the messages to the service. The force's key was `values` up to 3.4 and is `vector`
/// since.
class HaplyCommands {
 public:
  /// @param version  as the service states it, "3.5.0.0"; empty: it states none
  HaplyCommands(const std::string& device, const std::string& version);

  /// The first message: who the client is, and no force.
  std::string first() const;
  /// @param force  in the service's axes, finite [N]
  std::string force(const Eigen::Vector3d& force) const;

 private:
  std::string body(const Eigen::Vector3d& force) const;
  std::string begin_;
};

/// The version in the service's answer to GET /version; empty if there is none.
std::string read_haply_version(std::string_view text);

}  // namespace haptrial::device
