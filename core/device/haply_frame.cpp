#include "core/device/haply_frame.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

namespace haptrial::device {
namespace {

using Json = nlohmann::json;

/// The arrays in which the service lists grips.
constexpr std::array kGripLists{"wireless_verse_grip", "verse_grip", "custom_verse_grip"};
constexpr std::array kGripButtons{"a", "b", "c"};

/// The member of an object; null if there is none.
const Json* member(const Json* object, const char* name) {
  if (object == nullptr || !object->is_object()) {
    return nullptr;
  }
  const auto found = object->find(name);
  return found != object->end() ? &*found : nullptr;
}

std::string text_of(const Json* value) {
  return value != nullptr && value->is_string() ? value->get<std::string>() : "";
}

/// Numbers x, y, z or w, x, y, z of an object; false if one is missing or not finite.
template <std::size_t n>
bool read_numbers(const Json* object, const std::array<const char*, n>& names,
                  std::array<double, n>& into) {
  for (std::size_t i = 0; i < n; ++i) {
    const Json* const number = member(object, names[i]);
    if (number == nullptr || !number->is_number()) {
      return false;
    }
    into[i] = number->get<double>();
    if (!std::isfinite(into[i])) {
      return false;
    }
  }
  return true;
}

bool read_point(const Json* object, Eigen::Vector3d& into) {
  std::array<double, 3> numbers{};
  if (!read_numbers<3>(object, {"x", "y", "z"}, numbers)) {
    return false;
  }
  into = Eigen::Vector3d(numbers[0], numbers[1], numbers[2]);
  return true;
}

bool read_orientation(const Json* object, Eigen::Quaterniond& into) {
  std::array<double, 4> numbers{};
  if (!read_numbers<4>(object, {"w", "x", "y", "z"}, numbers)) {
    return false;
  }
  const Eigen::Quaterniond turn(numbers[0], numbers[1], numbers[2], numbers[3]);
  if (std::abs(turn.norm() - 1.0) > 0.01) {
    return false;
  }
  into = turn.normalized();
  return true;
}

/// The entry of this identifier in a list; null if there is none.
const Json* entry_of(const Json* list, const std::string& id) {
  if (list != nullptr && list->is_array()) {
    for (const Json& each : *list) {
      if (text_of(member(&each, "device_id")) == id) {
        return &each;
      }
    }
  }
  return nullptr;
}

bool is_one_of_three(const Json* vector, double expected) {
  Eigen::Vector3d read;
  return vector == nullptr || (read_point(vector, read) && read.isConstant(expected, 1e-9));
}

bool is_no_turn(const Json* rotation) {
  Eigen::Quaterniond read;
  return rotation == nullptr || (read_orientation(rotation, read) &&
                                 read.angularDistance(Eigen::Quaterniond::Identity()) < 1e-6);
}

/// Whether a transform, or a mount, changes nothing; the service leaves out what is plain.
bool is_plain(const Json* transform) {
  return is_one_of_three(member(transform, "position"), 0.0) &&
         is_one_of_three(member(transform, "scale"), 1.0) &&
         is_no_turn(member(transform, "rotation"));
}

HaplyListing read_listing(const Json& entry) {
  const Json* const config = member(&entry, "config");
  const std::string basis = text_of(member(member(config, "basis"), "permutation"));
  return {text_of(member(&entry, "device_id")), text_of(member(config, "type")),
          text_of(member(config, "handedness")),
          (basis.empty() || basis == "XYZ") && is_plain(member(config, "mount")) &&
              is_plain(member(member(&entry, "state"), "transform"))};
}

void add_listings(const Json* list, std::vector<HaplyListing>& into) {
  if (list != nullptr && list->is_array()) {
    for (const Json& each : *list) {
      into.push_back(read_listing(each));
    }
  }
}

bool is_false(const Json* flag) {
  return flag != nullptr && flag->is_boolean() && !flag->get<bool>();
}

HaplyFault status_of(const Json* status) {
  return is_false(member(status, "power_supply")) ? HaplyFault::kNoPower
         : is_false(member(status, "calibrated")) ? HaplyFault::kNotCalibrated
                                                  : HaplyFault::kNone;
}

HaplyFault read_grip(const Json& message, const std::string& id, HaplyState& state) {
  const Json* grip = nullptr;
  for (const char* list : kGripLists) {
    grip = grip == nullptr ? entry_of(member(&message, list), id) : grip;
  }
  if (grip == nullptr) {
    return HaplyFault::kGripMissing;
  }
  const Json* const sensed = member(grip, "state");
  if (!read_orientation(member(sensed, "orientation"), state.orientation)) {
    return HaplyFault::kMalformed;
  }
  const Json* const buttons = member(sensed, "buttons");
  for (std::size_t i = 0; i < kGripButtons.size(); ++i) {
    const Json* const button = member(buttons, kGripButtons[i]);
    if (button != nullptr && !button->is_boolean()) {
      return HaplyFault::kMalformed;
    }
    state.buttons |= button != nullptr && button->get<bool>() ? 1u << i : 0u;
  }
  return HaplyFault::kNone;
}

}  // namespace

const char* describe(HaplyFault fault) noexcept {
  switch (fault) {
    case HaplyFault::kNone:
      return "";
    case HaplyFault::kMalformed:
      return "the Inverse Service sent a state that cannot be read";
    case HaplyFault::kDeviceMissing:
      return "the Inverse Service no longer lists the device; check cable and power";
    case HaplyFault::kGripMissing:
      return "the Inverse Service no longer lists the grip; check its battery";
    case HaplyFault::kClosed:
      return "the connection to the Inverse Service ended; start the service again";
    case HaplyFault::kSilent:
      return "the Inverse Service gives no states";
    case HaplyFault::kNotCalibrated:
      return "the device is not calibrated";
    case HaplyFault::kNoPower:
      return "the device has no power supply and gives no force";
  }
  return "the Inverse Service failed";
}

std::optional<HaplyInventory> read_haply_inventory(std::string_view text) {
  const Json message = Json::parse(text, nullptr, false);
  const Json* const devices = member(&message, "inverse3");
  if (!message.is_object() || (devices == nullptr && !message.contains("session_id"))) {
    return std::nullopt;
  }
  HaplyInventory inventory;
  add_listings(devices, inventory.devices);
  for (const char* list : kGripLists) {
    add_listings(member(&message, list), inventory.grips);
  }
  return inventory;
}

HaplyState read_haply_state(std::string_view text, const std::string& device,
                            const std::string& grip, const HaplyState& before) {
  HaplyState state;
  state.status = before.status;
  const Json message = Json::parse(text, nullptr, false);
  if (!message.is_object()) {
    state.fault = HaplyFault::kMalformed;
    return state;
  }
  const Json* const entry = entry_of(member(&message, "inverse3"), device);
  const Json* const sensed = member(entry, "state");
  if (entry == nullptr) {
    state.fault = HaplyFault::kDeviceMissing;
  } else if (!read_point(member(sensed, "cursor_position"), state.cursor.position) ||
             !read_point(member(sensed, "cursor_velocity"), state.cursor.velocity)) {
    state.fault = HaplyFault::kMalformed;
  } else if (!grip.empty()) {
    state.fault = read_grip(message, grip, state);
  }
  if (const Json* const status = member(entry, "status")) {
    state.status = status_of(status);
  }
  return state;
}

HaplyCommands::HaplyCommands(const std::string& device, const std::string& version) {
  int major = 0;
  int minor = 0;
  const char* const end = version.data() + version.size();
  const char* const dot = std::from_chars(version.data(), end, major).ptr;
  if (dot != end && *dot == '.') {
    std::from_chars(dot + 1, end, minor);
  }
  const bool vector = major > 3 || (major == 3 && minor >= 5);
  begin_ = fmt::format(R"("inverse3":[{{"device_id":{},"commands":{{"set_cursor_force":{{"{}":)",
                       Json(device).dump(), vector ? "vector" : "values");
}

std::string HaplyCommands::body(const Eigen::Vector3d& force) const {
  return begin_ + fmt::format(R"({{"x":{:.6g},"y":{:.6g},"z":{:.6g}}}}}}}}}]}})", force.x(),
                              force.y(), force.z());
}

std::string HaplyCommands::first() const {
  return R"({"session":{"configure":{"profile":{"name":"haptrial"}}},)" +
         body(Eigen::Vector3d::Zero());
}

std::string HaplyCommands::force(const Eigen::Vector3d& force) const { return "{" + body(force); }

std::string read_haply_version(std::string_view text) {
  const Json answer = Json::parse(text, nullptr, false);
  const Json* const data = member(&answer, "data");  // since 3.5, if the client asks for it
  return text_of(member(data != nullptr ? data : &answer, "project_version"));
}

}  // namespace haptrial::device
