#include "experiments/rig.h"

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/device/force_dimension.h"
#include "core/device/mouse.h"
#include "core/device/open_haptics.h"
#include "core/device/replay.h"
#include "core/record/session_reader.h"
#include "experiments/virtual_rig.h"

namespace haptrial::experiments {
namespace {

constexpr std::string_view kReplay = "replay:";

/// A device with a person at it, or with a recording in a person's place.
class DeviceRig final : public Rig {
 public:
  explicit DeviceRig(std::unique_ptr<device::Device> device) : device_(std::move(device)) {}
  device::Device& device() override { return *device_; }

 private:
  std::unique_ptr<device::Device> device_;
};

class MouseRig final : public Rig {
 public:
  explicit MouseRig(double rate) : device_({}, rate) {}
  device::Device& device() override { return device_; }
  device::MouseDevice* mouse() override { return &device_; }

 private:
  device::MouseDevice device_;
};

std::unique_ptr<device::Device> replayed(const std::string& file, double rate) {
  const record::SessionReader reader(file);
  std::vector<PointState> hand;
  for (const record::Sample& sample : reader.samples(0, reader.sample_count())) {
    hand.push_back({sample.position, sample.velocity});
  }
  device::DeviceInfo info;
  info.name = "replay";
  info.max_force = reader.info().device_max_force;
  info.workspace_radius = reader.info().device_workspace_radius;
  info.simulated = reader.info().simulated;
  return std::make_unique<device::ReplayDevice>(std::move(hand), rate, info);
}

}  // namespace

void check_device_name(const std::string& name) {
  for (const char* known : {"virtual", "mouse", "force-dimension", "open-haptics"}) {
    if (name == known) {
      return;
    }
  }
  if (!name.starts_with(kReplay)) {
    throw InputError(
        fmt::format("--device is '{}'; allowed: virtual, mouse, force-dimension, "
                    "open-haptics, replay:FILE (haptrial devices says which are there)",
                    name));
  }
}

std::unique_ptr<Rig> make_rig(const std::string& name, const Definition& d,
                              std::uint64_t session_seed) {
  if (name == "mouse") {
    return std::make_unique<MouseRig>(d.rate);
  }
  if (name == "force-dimension") {
    return std::make_unique<DeviceRig>(
        std::make_unique<device::ForceDimensionDevice>(device::ForceDimensionParameters{}, d.rate));
  }
  if (name == "open-haptics") {
    return std::make_unique<DeviceRig>(
        std::make_unique<device::OpenHapticsDevice>(device::OpenHapticsParameters{}, d.rate));
  }
  if (name.starts_with(kReplay)) {
    return std::make_unique<DeviceRig>(replayed(name.substr(kReplay.size()), d.rate));
  }
  check_device_name(name);
  return std::make_unique<VirtualRig>(d, session_seed);
}

}  // namespace haptrial::experiments
