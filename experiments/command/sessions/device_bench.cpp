#include "experiments/command/sessions/device_bench.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/error.h"
#include "core/base/nearest.h"
#include "core/device/registered_devices.h"
#include "experiments/runner/devices.h"
#include "experiments/studies/experiment.h"
#include "experiments/studies/registry.h"

namespace haptrial::experiments {
namespace {

constexpr double kReachShare = 0.4;  // of the workspace's radius, to each side

/// A hand that is firm enough to try the workspace within a second.
constexpr device::CoupledMassParameters kFirmHand{1.0, 2000.0, 90.0};

/// Path of a hand that tries one axis after the other, there and back.
Eigen::Vector3d sweep(CheckPart part, double share, double radius) {
  const double start = DeviceCheck::start_of(CheckPart::kMove);
  const double sweep = (share - start) / (DeviceCheck::start_of(CheckPart::kPush) - start);
  if (part != CheckPart::kMove) {
    return Eigen::Vector3d::Zero();
  }
  const int axis = std::min(2, static_cast<int>(3.0 * sweep));
  return 0.7 * radius * std::sin(2.0 * std::numbers::pi * (3.0 * sweep - axis)) *
         Eigen::Vector3d::Unit(axis);
}

}  // namespace

DeviceSetup setup_of(const DeviceTestOptions& options) {
  DeviceSetup setup;
  if (!options.definition.empty()) {
    const Experiment experiment = load_experiment(options.definition);
    const protocols::Definition& d = *experiment.definition;
    setup = {d.device, d.hand, d.mouse, d.vendor, d.envelope.holding_force, {}};
    setup.margins = d.margins();
    setup.channels = d.channels;
    setup.arms = d.arms();
  } else {
    for (const Study* study : studies()) {
      const auto published = study->protocol().margins();
      setup.margins.insert(setup.margins.end(), published.begin(), published.end());
    }
  }
  setup.mouse.stop_button = -1;
  setup.mouse.in_space = false;
  setup.mouse.start.setZero();
  for (const device::VendorDevice& vendor : device::vendor_devices()) {
    vendor.free_stop_button(setup.vendor);
  }
  return setup;
}

namespace {

DeviceUnderTest virtual_bench(const device::VirtualDeviceParameters& parameters) {
  DeviceUnderTest bench;
  bench.handle = std::make_unique<device::CoupledMass>(kFirmHand);
  bench.device =
      std::make_unique<device::VirtualDevice>(parameters, *bench.handle, kDeviceTestRate);
  bench.hand = [handle = bench.handle.get(), parameters](CheckPart part, double share) {
    handle->set_anchor(sweep(part, share, parameters.workspace_radius));
  };
  bench.has_button = false;
  return bench;
}

DeviceUnderTest mouse_bench(device::MouseParameters parameters) {
  DeviceUnderTest bench;
  parameters.coupling = kFirmHand;
  parameters.pointer_speed = 2.0;
  auto mouse = std::make_unique<device::MouseDevice>(parameters, kDeviceTestRate);
  const double radius = mouse->info().workspace_radius;
  bench.hand = [mouse = mouse.get(), radius](CheckPart part, double share) {
    const Eigen::Vector3d where = sweep(part, share, radius);
    mouse->move(where.x(), where.z());
    mouse->set_buttons(part == CheckPart::kButton ? 1 : 0);
  };
  bench.device = std::move(mouse);
  return bench;
}

DeviceUnderTest vendor_bench(const DeviceTestOptions& options, const DeviceSetup& setup) {
  DeviceUnderTest bench;
  if (const device::VendorDevice* vendor = device::vendor_device(options.name)) {
    bench.device = vendor->open(setup.vendor, 0, kDeviceTestRate, options.library);
    bench.has_button = vendor->has_buttons(setup.vendor);
  } else if (const device::RegisteredDevice* own = device::registered_device(options.name)) {
    bench.device = own->open(device::setting_of(options.name), 0, kDeviceTestRate);
  } else {
    throw InputError(not_allowed("the device to test", fmt::format("'{}'", options.name),
                                 device::device_names()));
  }
  return bench;
}

}  // namespace

DeviceUnderTest make_bench(const DeviceTestOptions& options, const DeviceSetup& setup) {
  check_library(options.name, options.library);
  DeviceUnderTest bench = options.name == "virtual" ? virtual_bench(setup.electronics)
                          : options.name == "mouse" ? mouse_bench(setup.mouse)
                                                    : vendor_bench(options, setup);
  const double reach = kReachShare * bench.device->info().workspace_radius;
  bench.reach = reach * bench.device->info().force_axes;
  bench.reach.y() *= options.name == "mouse" ? 0.0 : 1.0;  // a pointer has no height
  return bench;
}

}  // namespace haptrial::experiments
