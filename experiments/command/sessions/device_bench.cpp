#include "experiments/command/sessions/device_bench.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "core/base/error.h"
#include "core/base/nearest.h"
#include "core/device/registered_devices.h"
#include "experiments/runner/devices.h"
#include "experiments/studies/experiment.h"
#include "experiments/studies/registry.h"

namespace haptrial::experiments {
namespace {

constexpr const char* kGamepad = "gamepad";

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
    std::vector<std::string> tested = device::device_names();
    std::erase(tested, kGamepad);
    throw InputError(not_allowed("the device to test", fmt::format("'{}'", options.name), tested));
  }
  return bench;
}

}  // namespace

DeviceUnderTest make_bench(const DeviceTestOptions& options, const DeviceSetup& setup) {
  check_library(options.name, options.library);
  if (options.name == kGamepad) {
    throw InputError(
        "a game controller has neither test nor certificate; try it in a session with --device "
        "gamepad");
  }
  DeviceUnderTest bench = options.name == "virtual" ? virtual_bench(setup.electronics)
                          : options.name == "mouse" ? mouse_bench(setup.mouse)
                                                    : vendor_bench(options, setup);
  const double reach = kReachShare * bench.device->info().workspace_radius;
  bench.reach = reach * bench.device->info().force_axes;
  bench.reach.y() *= options.name == "mouse" ? 0.0 : 1.0;  // a pointer has no height
  return bench;
}

namespace {

constexpr int kSteps = 6;                // +x -x +y -y +z -z
constexpr double kPushForce = 1.0;       // [N]
constexpr double kLeastYield = 1e-4;     // [m]
constexpr double kFarthestYield = 0.02;  // then the push ends: nobody holds the handle [m]
constexpr double kRateError = 0.01;

Eigen::Vector3d direction(int step) {
  return (step % 2 == 0 ? 1.0 : -1.0) * Eigen::Vector3d::Unit(step / 2);
}

}  // namespace

DeviceCheck::DeviceCheck(device::Device& device, const device::EnvelopeLimits& limits,
                         std::uint64_t ticks, Hand hand)
    : device_(device), envelope_(limits), ticks_(ticks), hand_(std::move(hand)) {
  if (ticks < 100) {
    throw std::invalid_argument("DeviceCheck: ticks must be at least 100");
  }
  findings_.force_axes = device.info().force_axes;
  findings_.push_force = std::min(kPushForce, 0.3 * device.info().max_force);
}

double DeviceCheck::start_of(CheckPart part) noexcept {
  switch (part) {
    case CheckPart::kRest:
      return 0.0;
    case CheckPart::kMove:
      return 0.2;
    case CheckPart::kPush:
      return 0.6;
    case CheckPart::kButton:
      return 0.9;
    case CheckPart::kDone:
      break;
  }
  return 1.0;
}

bool DeviceCheck::tick(const realtime::Tick& tick) noexcept {
  const double share = static_cast<double>(done_++) / static_cast<double>(ticks_);
  CheckPart part = CheckPart::kRest;
  for (const CheckPart next : {CheckPart::kMove, CheckPart::kPush, CheckPart::kButton}) {
    part = share >= start_of(next) ? next : part;
  }
  part_.store(part, std::memory_order_relaxed);
  if (hand_) {
    hand_(part, share);
  }

  device::DeviceReading reading;
  const bool read_ok = device_.read(reading);
  if (envelope_.check(read_ok, reading) != device::Fault::kNone) {
    findings_.trouble = device_.trouble();
  }
  Eigen::Vector3d wanted = Eigen::Vector3d::Zero();
  if (envelope_.fault() == device::Fault::kNone) {
    note(part, reading);
    wanted = part == CheckPart::kPush ? push(share, reading.tool.position) : wanted;
  }
  if (stop_.load(std::memory_order_relaxed)) {
    envelope_.trip(device::Fault::kEmergencyStop);
  }
  if (!device_.write(envelope_.limit(wanted, tick.dt)) &&
      envelope_.fault() == device::Fault::kNone) {
    envelope_.trip(device::Fault::kWriteFailed);
    findings_.trouble = device_.trouble();
  }
  findings_.fault = envelope_.fault();
  const bool more = done_ < ticks_ && findings_.fault == device::Fault::kNone;
  if (!more) {
    device_.write(Eigen::Vector3d::Zero());
    stopped_.store(true, std::memory_order_release);
    part_.store(CheckPart::kDone, std::memory_order_relaxed);
  }
  return more;
}

void DeviceCheck::note(CheckPart part, const device::DeviceReading& reading) noexcept {
  const Eigen::Vector3d& p = reading.tool.position;
  if (part == CheckPart::kRest) {
    rest_low_ = has_rest_ ? rest_low_.cwiseMin(p).eval() : p;
    rest_high_ = has_rest_ ? rest_high_.cwiseMax(p).eval() : p;
    has_rest_ = true;
    findings_.rest_noise = (rest_high_ - rest_low_).maxCoeff();
  } else if (part == CheckPart::kMove) {
    findings_.lowest = has_move_ ? findings_.lowest.cwiseMin(p).eval() : p;
    findings_.highest = has_move_ ? findings_.highest.cwiseMax(p).eval() : p;
    has_move_ = true;
  } else if (part == CheckPart::kButton) {
    findings_.buttons |= reading.buttons;
  }
}

// Each step is half force and half rest; how far the tool went shows at the end of the force.
Eigen::Vector3d DeviceCheck::push(double share, const Eigen::Vector3d& position) noexcept {
  const double span = start_of(CheckPart::kButton) - start_of(CheckPart::kPush);
  const double where = kSteps * (share - start_of(CheckPart::kPush)) / span;
  const int step = std::clamp(static_cast<int>(where), 0, kSteps - 1);
  if (step != step_) {
    step_ = step;
    before_ = position;
  }
  const bool on = where - step < 0.5;
  if (!on) {
    findings_.pushed = step == kSteps - 1;
    return Eigen::Vector3d::Zero();
  }
  double& yielded = findings_.yielded[static_cast<std::size_t>(step)];
  const double now = direction(step).dot(position - before_);
  yielded = std::max(yielded, now);
  return now > kFarthestYield
             ? Eigen::Vector3d::Zero().eval()
             : (findings_.push_force * direction(step)).cwiseProduct(findings_.force_axes).eval();
}

namespace {

Verdict judge_rate(const realtime::ServoLoop& loop) {
  const double asked = loop.rate_hz();
  const double mean = 1e9 / loop.timing().period.mean();
  return {
      std::abs(mean / asked - 1.0) < kRateError, "rate",
      fmt::format("{:.2f} Hz over {} ticks; {:.0f} Hz was requested", mean, loop.ticks(), asked)};
}

Verdict judge_lateness(const realtime::ServoLoop& loop) {
  const auto& late = loop.timing().lateness;
  const double period = 1e9 / loop.rate_hz();
  return {
      late.percentile(99.0) < period && loop.resynchronised() == 0, "lateness",
      fmt::format("median {:.1f} µs, 99th percentile {:.1f} µs, 99.9th {:.1f} µs, worst {:.1f} "
                  "µs, {} overruns; the 99th must stay below a period, {:.0f} µs",
                  1e-3 * late.percentile(50.0), 1e-3 * late.percentile(99.0),
                  1e-3 * late.percentile(99.9), 1e-3 * late.max(), loop.overruns(), 1e-3 * period)};
}

/// In millimetres and tenths; nothing is just below 0.
double tenths(double metres) { return 0.1 * std::round(1e4 * metres) + 0.0; }

Verdict judge_workspace(const DeviceFindings& f, const Eigen::Vector3d& reach) {
  const bool good =
      (f.lowest.array() <= -reach.array()).all() && (f.highest.array() >= reach.array()).all();
  return {
      good, "workspace",
      fmt::format("x {:.1f} to {:.1f} mm, y {:.1f} to {:.1f} mm, z {:.1f} to {:.1f} mm; {:.1f}, "
                  "{:.1f} and {:.1f} mm to each side are needed",
                  tenths(f.lowest.x()), tenths(f.highest.x()), tenths(f.lowest.y()),
                  tenths(f.highest.y()), tenths(f.lowest.z()), tenths(f.highest.z()),
                  1e3 * reach.x(), 1e3 * reach.y(), 1e3 * reach.z())};
}

Verdict judge_pushes(const DeviceFindings& f) {
  const auto& y = f.yielded;
  bool good = f.pushed;
  for (int step = 0; step < kSteps; ++step) {
    const bool gives_force = f.force_axes[step / 2] > 0.0;
    good = good && (!gives_force || y[static_cast<std::size_t>(step)] >= kLeastYield);
  }
  return {
      good, "force steps",
      fmt::format("{:.2f} N moved the tool by {:.2f} {:.2f} (x) {:.2f} {:.2f} (y) {:.2f} {:.2f} "
                  "mm (z), + and -; at least {:.1f} mm along the force is needed",
                  f.push_force, 1e3 * y[0], 1e3 * y[1], 1e3 * y[2], 1e3 * y[3], 1e3 * y[4],
                  1e3 * y[5], 1e3 * kLeastYield)};
}

}  // namespace

std::vector<Verdict> judge(const DeviceFindings& findings, const realtime::ServoLoop& loop,
                           const Eigen::Vector3d& reach, bool has_button) {
  std::vector<Verdict> all;
  if (findings.fault != device::Fault::kNone) {
    const bool said = findings.trouble[0] != '\0';
    all.push_back({false, "device",
                   fmt::format("the check ended early: {}{}{}", device::describe(findings.fault),
                               said ? "; " : "", findings.trouble)});
  }
  all.push_back(judge_rate(loop));
  all.push_back(judge_lateness(loop));
  all.push_back(
      {true, "rest", fmt::format("position within {:.3f} mm", 1e3 * findings.rest_noise)});
  all.push_back(judge_workspace(findings, reach));
  all.push_back(judge_pushes(findings));
  all.push_back(has_button ? Verdict{findings.buttons != 0, "button",
                                     findings.buttons != 0 ? "seen" : "none was pressed"}
                           : Verdict{true, "button", "this device has none"});
  return all;
}

}  // namespace haptrial::experiments
