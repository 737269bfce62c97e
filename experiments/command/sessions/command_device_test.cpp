#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <chrono>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <thread>

#include "core/base/error.h"
#include "core/base/nearest.h"
#include "core/device/coupled_mass.h"
#include "core/device/mouse.h"
#include "core/device/registered_devices.h"
#include "core/device/vendor_devices.h"
#include "experiments/command/sessions/device_check.h"
#include "experiments/command/subcommand.h"
#include "experiments/control/fatal_stop_handler.h"
#include "experiments/control/interrupt.h"
#include "experiments/control/signals.h"
#include "experiments/runner/devices.h"
#include "experiments/studies/experiment.h"
#include "experiments/studies/registry.h"

namespace haptrial::experiments {
namespace {

struct DeviceTestOptions {
  std::string name;
  std::string definition;
  double seconds{120.0};
  std::string library;
};

constexpr double kRate = 1000.0;     // [Hz]
constexpr double kReachShare = 0.4;  // of the workspace's radius, to each side

/// A device, and who moves it where there is no person.
struct DeviceUnderTest {
  std::unique_ptr<device::CoupledMass> handle;  // of the virtual device
  std::unique_ptr<device::Device> device;
  DeviceCheck::Hand hand;
  Eigen::Vector3d reach;  // what counts as having tried the workspace, to each side [m]
  bool has_button{true};
};

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

/// How the devices are set up; a stop button is a button like any other here.
struct DeviceSetup {
  device::VirtualDeviceParameters electronics;
  device::MouseParameters mouse;
  device::VendorSetups vendor;
  double holding_force{
      device::EnvelopeLimits{}.holding_force};  // a device may have more friction [N]
  std::vector<std::string> margins;             // of the definition, or the published ones
};

DeviceSetup setup_of(const DeviceTestOptions& options) {
  DeviceSetup setup;
  if (!options.definition.empty()) {
    const Experiment experiment = load_experiment(options.definition);
    const protocols::Definition& d = *experiment.definition;
    setup = {d.device, d.mouse, d.vendor, d.envelope.holding_force, {}};
    setup.margins = d.margins();
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

DeviceUnderTest virtual_bench(const device::VirtualDeviceParameters& parameters) {
  DeviceUnderTest bench;
  bench.handle = std::make_unique<device::CoupledMass>(kFirmHand);
  bench.device = std::make_unique<device::VirtualDevice>(parameters, *bench.handle, kRate);
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
  auto mouse = std::make_unique<device::MouseDevice>(parameters, kRate);
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
    bench.device = vendor->open(setup.vendor, 0, kRate, options.library);
    bench.has_button = vendor->has_buttons(setup.vendor);
  } else if (const device::RegisteredDevice* own = device::registered_device(options.name)) {
    bench.device = own->open(device::setting_of(options.name), 0, kRate);
  } else {
    throw InputError(not_allowed("the device to test", fmt::format("'{}'", options.name),
                                 device::device_names()));
  }
  return bench;
}

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

/// The speed and jump of a hand that tries the workspace are not those of a trial.
device::EnvelopeLimits limits_of(const device::DeviceInfo& info, const DeviceSetup& setup) {
  device::EnvelopeLimits limits;
  limits.holding_force = setup.holding_force;
  limits.max_force = 0.4 * info.max_force;
  limits.max_force_rate = 200.0;
  limits.workspace_radius = 2.0 * info.workspace_radius;  // further than the handle can go
  limits.max_speed = 2.0;
  limits.max_jump = 0.02;  // a fast hand, and a loop that was late
  limits.ramp_in = 0.0;
  return limits;
}

const char* prompt(CheckPart part) {
  switch (part) {
    case CheckPart::kRest:
      return "hold the handle still in the middle";
    case CheckPart::kMove:
      return "move the handle to every side: left and right, up and down, near and far";
    case CheckPart::kPush:
      return "hold the handle loosely in the middle: the device pushes gently, six times";
    case CheckPart::kButton:
      return "press a button of the handle";
    case CheckPart::kDone:
      break;
  }
  return "";
}

/// Takes the force away when the program is interrupted or dies.
class CheckStop final : public FatalStopHandler {
 public:
  CheckStop(DeviceCheck& check, device::Device& device) : check_(check), device_(device) {}
  void set_servo_thread() { servo_ = ::gettid(); }
  void ask() noexcept override { check_.stop(); }
  bool done() const noexcept override { return check_.stopped(); }
  bool on_servo_thread() const noexcept override { return servo_.load() == ::gettid(); }
  void write_zero() noexcept override { device_.write(Eigen::Vector3d::Zero()); }

 private:
  DeviceCheck& check_;
  device::Device& device_;
  std::atomic<pid_t> servo_{0};
};

/// Runs the loop on a thread of its own, and tells the person what to do.
void run_check(DeviceCheck& check, device::Device& device, realtime::ServoLoop& loop, bool person) {
  CheckStop stop(check, device);
  const WatchedStop watched(stop);
  std::thread servo([&] {
    stop.set_servo_thread();
    loop.run(check);
  });
  std::optional<CheckPart> told;
  while (check.part() != CheckPart::kDone) {
    if (person && told != check.part() && check.part() != CheckPart::kDone) {
      told = check.part();
      fmt::print("-> {}\n", prompt(*told));
      std::fflush(stdout);
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  servo.join();
  if (interrupted()) {
    throw RunError("interrupted; the check came to no verdict");
  }
}

/// @returns 0 when the device is fit for use, else 1.
int device_test(const DeviceTestOptions& options) {
  watch_for_interrupt();
  watch_fatal_signals();
  constexpr double kLeast = 1.0;
  constexpr double kMost = 3600.0;
  if (!(options.seconds >= kLeast && options.seconds <= kMost)) {
    throw InputError(fmt::format("--seconds is {}; allowed: a number from {} to {} [s]",
                                 options.seconds, kLeast, kMost));
  }
  const DeviceSetup setup = setup_of(options);
  DeviceUnderTest bench = make_bench(options, setup);
  const device::DeviceInfo& info = bench.device->info();
  fmt::print("{}{}: {:.1f} N, workspace radius {:.0f} mm\n", info.name,
             info.simulated ? " (simulated)" : "", info.max_force, 1e3 * info.workspace_radius);
  const auto ticks = static_cast<std::uint64_t>(std::lround(options.seconds * kRate));
  DeviceCheck check(*bench.device, limits_of(info, setup), ticks, bench.hand);
  realtime::ServoLoop loop(realtime::ClockKind::kReal, kRate);
  run_check(check, *bench.device, loop, !bench.hand);

  bool good = true;
  for (const Verdict& v : judge(check.findings(), loop, bench.reach, bench.has_button)) {
    fmt::print("{}  {:<12} {}\n", v.good ? "good" : "FAIL", v.what, v.text);
    good = good && v.good;
  }
  fmt::print("      {:<12} {} took longer than a period\n", "calls", bench.device->slow_calls());
  for (const std::string& margin : setup.margins) {
    fmt::print("      {:<12} {}\n", "margin", margin);
  }
  if (!loop.real_time_status().notice.empty()) {
    fmt::print("{}\n", loop.real_time_status().notice);
  }
  fmt::print("verdict: {} {}\n", options.name, good ? "is fit for use" : "is NOT fit for use");
  return good ? 0 : 1;
}

}  // namespace

void add_device_test(CLI::App& app, int& status) {
  CLI::App* sub = subcommand(app, "device-test", "Check whether a device is fit for experiments",
                             "haptrial device-test force-dimension", {"", "devices.md"});
  auto& o = options_of<DeviceTestOptions>(*sub, status, device_test);
  sub->add_option("NAME", o.name,
                  fmt::format("Device: virtual, mouse, {} or one of this program's own",
                              fmt::join(device::vendor_names(), ", ")))
      ->required();
  sub->add_option(
      "--definition", o.definition,
      "Definition whose set-up of the device is checked (.toml) (default: the driver's own)");
  sub->add_option("--seconds", o.seconds, with_default("Duration [s]", o.seconds));
  sub->add_option("--library", o.library,
                  "Path of the vendor's library (default: found by the system)");
}

}  // namespace haptrial::experiments
