#include "experiments/runner/devices.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "core/base/error.h"
#include "core/base/nearest.h"
#include "core/device/gamepad.h"
#include "core/device/mirrored_device.h"
#include "core/device/mouse.h"
#include "core/device/registered_devices.h"
#include "core/device/replay.h"
#include "core/device/vendor_devices.h"
#include "core/record/read/session_reader.h"
#include "core/record/read/tick_rows.h"

namespace haptrial::experiments {
namespace {

constexpr std::string_view kReplay = "replay:";
constexpr const char* kBetween = ", ";  // names of several devices
constexpr const char* kMouse = "mouse";
constexpr const char* kGamepad = "gamepad";

/// A device with a person at it, or with a recording in a person's place.
class DeviceRig final : public protocols::Rig {
 public:
  explicit DeviceRig(std::unique_ptr<device::Device> device) : device_(std::move(device)) {}
  device::Device& device() override { return *device_; }

 private:
  std::unique_ptr<device::Device> device_;
};

class MouseRig final : public protocols::Rig {
 public:
  explicit MouseRig(const protocols::Definition& d) : device_(d.mouse, d.rate) {}
  device::Device& device() override { return device_; }
  device::MouseDevice* mouse() override { return &device_; }

 private:
  device::MouseDevice device_;
};

/// A mouse whose pointer a game controller moves.
class GamepadRig final : public protocols::Rig {
 public:
  explicit GamepadRig(const protocols::Definition& d)
      : gamepad_(d.gamepad), device_(mouse_of(d), d.rate, kGamepad) {}
  device::Device& device() override { return device_; }
  device::MouseDevice* mouse() override { return &device_; }
  device::Gamepad* gamepad() override { return &gamepad_; }

 private:
  static device::MouseParameters mouse_of(const protocols::Definition& d) {
    device::MouseParameters mouse = d.mouse;
    mouse.stop_button = d.gamepad.stop_button;
    return mouse;
  }
  device::Gamepad gamepad_;
  device::MouseDevice device_;
};

/// Devices that people hold, with the parts of them that the definition names.
class SeveralDevices final : public protocols::Rig {
 public:
  explicit SeveralDevices(std::unique_ptr<protocols::Rig> first) : first_(std::move(first)) {
    arms_.push_back({&first_->device(), {}});
  }
  void add(std::unique_ptr<protocols::Rig> rig, const protocols::DeviceArm& arm) {
    arms_.push_back({&rig->device(), arm.limits});
    others_.push_back(std::move(rig));
  }
  /// A part of a device that was added before.
  void add(const protocols::DeviceArm& arm) {
    arms_.push_back({arms_[arm.of].device, arm.limits, arm.part, arm.radius, arm.handle_mass});
  }
  device::Device& device() override { return first_->device(); }
  device::MouseDevice* mouse() override { return first_->mouse(); }
  device::Gamepad* gamepad() override { return first_->gamepad(); }
  std::vector<protocols::DeviceSet::Arm> others() override {
    return {arms_.begin() + 1, arms_.end()};
  }

 private:
  std::unique_ptr<protocols::Rig> first_;
  std::vector<std::unique_ptr<protocols::Rig>> others_;
  std::vector<protocols::DeviceSet::Arm> arms_;  // with the first
};

std::unique_ptr<device::Device> replayed(const std::string& file, double rate) {
  const record::SessionReader reader(file);
  if (reader.info().rate != rate) {
    throw InputError(fmt::format("{}: was recorded at {} Hz; allowed: the definition's rate, {} Hz",
                                 file, reader.info().rate, rate));
  }
  std::vector<PointState> hand;
  for (const record::Sample& sample : reader.samples(0, reader.sample_count())) {
    hand.push_back({sample.position, sample.velocity});
  }
  std::vector<std::size_t> starts;
  for (const record::PassRow& pass : reader.passes()) {
    if (pass.status == record::PassStatus::kCompleted) {
      starts.push_back(static_cast<std::size_t>(record::span_of_pass(reader, pass).first));
    }
  }
  device::DeviceInfo info;
  info.name = "replay";
  info.max_force = reader.info().device_max_force;
  info.workspace_radius = reader.info().device_workspace_radius;
  info.simulated = reader.info().simulated;
  return std::make_unique<device::ReplayDevice>(std::move(hand), rate, info, std::move(starts));
}

std::unique_ptr<protocols::Rig> open_rig(
    const DeviceChoice& choice, const protocols::Definition& d,
    const std::function<std::unique_ptr<protocols::Rig>()>& virtual_rig) {
  const auto with = [](auto device) { return std::make_unique<DeviceRig>(std::move(device)); };
  const auto held = [&](std::unique_ptr<device::Device> device) {
    if (d.display.mirrored) {
      device = std::make_unique<device::MirroredDevice>(std::move(device));
    }
    return with(std::move(device));
  };
  if (choice.name == kMouse) {
    return std::make_unique<MouseRig>(d);
  }
  if (choice.name == kGamepad) {
    if (d.gamepad.input.empty()) {
      throw InputError(fmt::format(
          "{}: --device gamepad needs a table [gamepad] whose input says which input device that "
          "is; /dev/input/by-id names what is connected",
          d.file_name));
    }
    return std::make_unique<GamepadRig>(d);
  }
  if (const device::VendorDevice* vendor = device::vendor_device(choice.name)) {
    return held(vendor->open(d.vendor, choice.number, d.rate, choice.library));
  }
  if (const auto file = replayed_file(choice.name)) {
    return with(replayed(*file, d.rate));
  }
  if (const device::RegisteredDevice* own = device::registered_device(choice.name)) {
    return held(own->open(device::setting_of(choice.name), choice.number, d.rate));
  }
  check_device_name(choice.name);
  return virtual_rig();
}

/// @throws InputError for a rotation or grip without motors, or with weaker ones
void check_part(const device::DeviceInfo& info, const protocols::DeviceArm& arm,
                const std::string& file_name) {
  const device::PartUnits unit = arm.units();
  const double most = device::most_force(arm.part, info, arm.radius);
  if (most <= 0.0) {
    throw InputError(
        fmt::format("{}: devices.{} wants a {}, which the {} does not give; leave it "
                    "out, or choose a device that does (haptrial devices)",
                    file_name, arm.name, device::force_word(arm.part), info.name));
  }
  if (arm.limits.max_force > most) {
    throw InputError(fmt::format(
        "{}: the max_force of devices.{} is {:g} {}; allowed: at most {:g} {}, which is what the "
        "{} gives",
        file_name, arm.name, unit.newton * arm.limits.max_force, unit.force, unit.newton * most,
        unit.force, info.name));
  }
}

/// A weaker device would saturate unseen, a smaller one would stop at its walls.
void check_reach(const device::DeviceInfo& info, const protocols::Definition& d) {
  const auto check = [&](const char* key, double wanted, double most, const char* unit) {
    if (wanted > most) {
      throw InputError(
          fmt::format("{}: envelope.{} is {} {}; allowed: at most {}, which is what "
                      "the {} gives",
                      d.file_name, key, wanted, unit, most, info.name));
    }
  };
  check("max_force", d.envelope.max_force, info.max_force, "N");
  check("workspace_radius", d.envelope.workspace_radius, info.workspace_radius, "m");
}

/// Reports and warnings take the figures of the certificate for those of the device.
/// Devices of one kind have one name, so that their certificates are not told apart.
/// @throws InputError for a certificate of another kind of device
void check_certificate(const device::DeviceInfo& info, const protocols::Definition& d) {
  if (d.certificate &&
      (d.certificate->simulated != info.simulated || d.certificate->device != info.name)) {
    throw InputError(fmt::format(
        "{}: {} is the certificate of {}{}, and the session's device is {}; leave it out, or make "
        "one of this device (haptrial device-test NAME --certificate FOLDER)",
        d.file_name, d.certificate->file, d.certificate->device,
        d.certificate->simulated ? " (simulated)" : "", info.name));
  }
}

/// The window's pointer moves the first device alone; any other mouse would stand still.
/// @throws InputError for a mouse or a game controller
void check_pointer(const DeviceChoice& choice, const protocols::DeviceArm& arm,
                   const std::string& file_name) {
  if (choice.name == kMouse || choice.name == kGamepad) {
    throw InputError(fmt::format(
        "{}: {} would be driven by --device {}, which drives the first device alone; give each "
        "device a --device of its own, as --device {} --device virtual",
        file_name, arm.name.empty() ? "the second device" : "device " + arm.name, choice.name,
        choice.name));
  }
}

/// Opens the devices after the first, each as its choice says or like the one before, and adds the
/// parts that are driven.
std::unique_ptr<protocols::Rig> with_others(
    std::unique_ptr<protocols::Rig> first, const std::vector<DeviceChoice>& choices,
    const protocols::Definition& d,
    const std::function<std::unique_ptr<protocols::Rig>()>& virtual_rig) {
  const std::vector<protocols::DeviceArm> arms = d.arms();
  auto together = std::make_unique<SeveralDevices>(std::move(first));
  std::size_t opened = 1;
  for (std::size_t i = 1; i < arms.size(); ++i) {
    if (arms[i].part != device::Part::kTip) {
      together->add(arms[i]);
      check_part(together->others().back().device->info(), arms[i], d.file_name);
      continue;
    }
    const DeviceChoice choice = choice_of(choices, opened);
    check_pointer(choice, arms[i], d.file_name);
    together->add(open_rig(choice, d, virtual_rig), arms[i]);
    ++opened;
  }
  return together;
}

}  // namespace

void check_device_name(const std::string& name) {
  if (name == kReplay) {
    throw InputError("--device replay: names no file; write replay:FILE");
  }
  std::vector<std::string> known = device::device_names();
  if (!name.starts_with(kReplay) && device::registered_device(name) == nullptr &&
      std::find(known.begin(), known.end(), name) == known.end()) {
    known.emplace_back("replay:FILE");
    throw InputError(not_allowed("--device", fmt::format("'{}'", name), known) +
                     " (haptrial devices lists which are present)");
  }
}

bool takes_library(const std::string& device) {
  const device::VendorDevice* const vendor = device::vendor_device(device);
  return vendor != nullptr && vendor->takes_library;
}

void check_library(const std::string& device, const std::string& library) {
  if (!library.empty() && !takes_library(device)) {
    std::vector<std::string> others = device::vendor_names();
    std::erase_if(others, [](const std::string& name) { return !takes_library(name); });
    throw InputError(
        fmt::format("--library is given with device {}, which uses no vendor's library; leave it "
                    "out, or choose {}",
                    device, fmt::join(others, " or ")));
  }
}

std::optional<std::string> replayed_file(const std::string& device) {
  return device.starts_with(kReplay) ? std::optional(device.substr(kReplay.size())) : std::nullopt;
}

DeviceChoice choice_of(const std::vector<DeviceChoice>& choices, std::size_t device) {
  DeviceChoice choice = choices[std::min(device, choices.size() - 1)];
  choice.number += device < choices.size() ? 0 : static_cast<int>(device - choices.size() + 1);
  return choice;
}

std::string devices_text(const std::vector<DeviceChoice>& choices, int devices) {
  std::string text;
  for (int i = 0; i < devices; ++i) {
    text += (i > 0 ? kBetween : "") + choice_of(choices, static_cast<std::size_t>(i)).name;
  }
  return text;
}

std::vector<std::string> devices_in(const std::string& text) {
  std::vector<std::string> names;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find(kBetween, begin), text.size());
    names.push_back(text.substr(begin, end - begin));
    begin = end + std::string_view(kBetween).size();
  }
  return names;
}

std::unique_ptr<protocols::Rig> make_rig(
    const std::vector<DeviceChoice>& choices, const protocols::Definition& d,
    const std::function<std::unique_ptr<protocols::Rig>()>& virtual_rig) {
  std::unique_ptr<protocols::Rig> rig = open_rig(choices.front(), d, virtual_rig);
  if (rig->others().size() + 1 < d.arms().size()) {  // a virtual rig has all of them
    rig = with_others(std::move(rig), choices, d, virtual_rig);
  }
  const std::string& name = choices.front().name;
  if (device::vendor_device(name) != nullptr || device::registered_device(name) != nullptr) {
    check_certificate(rig->device().info(), d);
  }
  check_reach(rig->device().info(), d);
  for (const protocols::DeviceSet::Arm& arm : rig->others()) {
    check_reach(arm.device->info(), d);
  }
  return rig;
}

}  // namespace haptrial::experiments
