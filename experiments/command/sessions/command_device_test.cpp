#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cmath>
#include <optional>
#include <thread>

#include "core/base/error.h"
#include "experiments/command/sessions/certify_device.h"
#include "experiments/command/sessions/live_reading.h"
#include "experiments/command/sessions/measure_loopback.h"
#include "experiments/command/subcommand.h"
#include "experiments/control/interrupt.h"
#include "experiments/control/signals.h"

namespace haptrial::experiments {
namespace {

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

/// Runs the loop on a thread of its own, and tells the person what to do.
void run_check(DeviceCheck& check, device::Device& device, realtime::ServoLoop& loop, bool person) {
  TaskStop stop(check, device);
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
  if (!options.loopback.empty()) {
    return measure_loopback(options);
  }
  const DeviceSetup setup = setup_of(options);
  if (!options.certificate.empty()) {
    return certify_device(options, setup);
  }
  if (options.mass != 0.0 || options.without_sensor || !options.sensor.empty() ||
      !options.grip_sensor.empty()) {
    throw InputError(
        "--mass, --sensor, --grip-sensor and --without-sensor belong to "
        "--certificate FOLDER");
  }
  if (options.read) {
    return print_live_device(options, setup);
  }
  DeviceUnderTest bench = make_bench(options, setup);
  const device::DeviceInfo& info = bench.device->info();
  fmt::print("{}{}: {:.1f} N, workspace radius {:.0f} mm\n", info.name,
             info.simulated ? " (simulated)" : "", info.max_force, 1e3 * info.workspace_radius);
  const auto ticks = static_cast<std::uint64_t>(std::lround(options.seconds * kDeviceTestRate));
  DeviceCheck check(*bench.device, limits_of(info, setup), ticks, bench.hand);
  realtime::ServoLoop loop(realtime::ClockKind::kReal, kDeviceTestRate);
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
                  fmt::format("Device: virtual, mouse, {} or one of this program's own; with "
                              "--loopback a sound of the definition",
                              fmt::join(device::vendor_names(), ", ")))
      ->required();
  sub->add_option(
      "--definition", o.definition,
      "Definition whose set-up of the device is checked (.toml) (default: the driver's own)");
  sub->add_option("--seconds", o.seconds, with_default("Duration [s]", o.seconds));
  sub->add_flag("--read", o.read,
                "Print where the handle is and which buttons are pressed, without force");
  sub->add_option("--certificate", o.certificate,
                  "Folder for a certificate: what the device does, with intervals");
  sub->add_option("--mass", o.mass,
                  "Known mass that you fix to the handle for a certificate [kg] (default: none)");
  sub->add_option("--sensor", o.sensor,
                  "Channel of the definition, a force sensor to which you clamp the handle for a "
                  "certificate; one that also measures torque is the rotation's sensor, too");
  sub->add_option("--grip-sensor", o.grip_sensor,
                  "Channel of the definition that measures the grip force as the quantity grip");
  sub->add_option(
      "--sensor-axes", o.sensor_axes,
      with_default("Axes of the world along which the sensor's x, y and z point", o.sensor_axes));
  sub->add_flag("--without-sensor", o.without_sensor,
                "Certificate of the virtual device without its simulated force sensor");
  sub->add_option("--loopback", o.loopback,
                  "Recording of a session with the sound NAME, whose latency is measured: markers' "
                  "pulses in the first channel, the sound in the second");
  sub->add_option("--library", o.library,
                  "Path of the vendor's library (default: found by the system)");
}

}  // namespace haptrial::experiments
