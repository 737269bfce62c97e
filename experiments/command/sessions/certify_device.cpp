#include "experiments/command/sessions/certify_device.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <optional>
#include <thread>

#include "analysis/device/certificate_report.h"
#include "core/base/error.h"
#include "core/device/sensed_mount.h"
#include "experiments/command/sessions/certificate_task.h"
#include "experiments/command/sessions/sensor_channel.h"
#include "experiments/control/interrupt.h"

namespace haptrial::experiments {
namespace {

const char* certificate_prompt(analysis::CertificatePart part) {
  switch (part) {
    case analysis::CertificatePart::kRest:
      return "keep the handle still: put it down, or clamp it";
    case analysis::CertificatePart::kFree:
      return "let the handle go, with free space around it: the device moves it";
    case analysis::CertificatePart::kLoaded:
      return "fix the known mass to the handle and let it go: the device moves it";
    case analysis::CertificatePart::kWall:
      return "take the mass off and let the handle go: the device presses it against walls";
    case analysis::CertificatePart::kGrid:
      return "clamp the handle to the force sensor in the middle of the workspace";
    case analysis::CertificatePart::kFrequency:
      return "leave the handle clamped";
    case analysis::CertificatePart::kMove:
    case analysis::CertificatePart::kDone:
      break;
  }
  return "";
}

/// Runs the parts on a real clock; each begins ten seconds after the person was told.
void run_certificate(CertificateTask& task, device::Device& device, realtime::ServoLoop& loop) {
  constexpr int kCountdown = 10;  // [s]
  TaskStop stop(task, device);
  const WatchedStop watched(stop);
  std::thread servo([&] {
    stop.set_servo_thread();
    loop.run(task);
  });
  std::optional<analysis::CertificatePart> told;
  auto begin = std::chrono::steady_clock::now();
  while (task.part() != analysis::CertificatePart::kDone) {
    if (told != task.part()) {
      told = task.part();
      begin = std::chrono::steady_clock::now() + std::chrono::seconds(kCountdown);
      fmt::print("-> {}; it begins in {} s\n", certificate_prompt(*told), kCountdown);
      std::fflush(stdout);
    }
    if (std::chrono::steady_clock::now() >= begin) {
      task.start();
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  servo.join();
}

/// The virtual device's faults, for the page of its certificate.
std::vector<std::string> planted(const DeviceSetup& setup) {
  const device::MotorFaults& f = setup.electronics.faults;
  return {fmt::format("gain {}, dead zone {} N, gravity error {} N", f.gain, f.dead_zone,
                      f.gravity_error),
          fmt::format("cogging {} N every {} m", f.cogging, f.cogging_period),
          f.resonance > 0.0
              ? fmt::format("resonance {} Hz, damping {}", f.resonance, f.resonance_damping)
              : "no resonance",
          fmt::format("delay {} ms, friction {} N, inertia {} kg",
                      1e3 * setup.electronics.force_delay / kDeviceTestRate,
                      setup.hand.coulomb_friction, setup.hand.handle_mass)};
}

/// The certificate of the virtual device, whose handle a mount holds, moves and lets go.
analysis::CertificateRecord virtual_record(const DeviceTestOptions& options,
                                           const DeviceSetup& setup,
                                           const analysis::Excitation& excitation,
                                           std::vector<analysis::CertificatePart> parts) {
  using analysis::CertificatePart;
  device::SensedMount mount({.mass = setup.hand.handle_mass,
                             .friction = setup.hand.coulomb_friction,
                             .noise = setup.electronics.faults.sensor_noise,
                             .added_mass = options.mass},
                            1);
  device::VirtualDevice device(setup.electronics, mount, kDeviceTestRate);
  const double reach = 0.5 * setup.electronics.workspace_radius;
  if (!options.without_sensor) {
    parts.insert(parts.begin() + 1,
                 {CertificatePart::kGrid, CertificatePart::kFrequency, CertificatePart::kMove});
  }
  CertificateTask task(device, options.without_sensor ? nullptr : &mount, excitation, parts,
                       [&mount, &excitation, reach](CertificatePart part, long tick) {
                         mount.carry(part == CertificatePart::kLoaded);
                         if (part == CertificatePart::kFree || part == CertificatePart::kLoaded ||
                             part == CertificatePart::kWall) {
                           mount.release();
                         } else {
                           mount.hold(excitation.position(part, tick + 1, reach));
                         }
                       });
  realtime::ServoLoop loop(realtime::ClockKind::kSimulated, kDeviceTestRate);
  loop.run(task);
  analysis::CertificateRecord record = task.record();
  if (task.fault() != device::Fault::kNone) {
    throw RunError(fmt::format("the certificate ended early: {}", device::describe(task.fault())));
  }
  record.plant = planted(setup);
  return record;
}

/// The channel that the options name. @throws InputError if the definition has no such channel
const channel::ChannelOptions& sensor_of(const DeviceTestOptions& options,
                                         const DeviceSetup& setup) {
  const auto found =
      std::ranges::find(setup.channels, options.sensor, &channel::ChannelOptions::name);
  if (found == setup.channels.end()) {
    throw InputError(
        options.definition.empty()
            ? fmt::format("--sensor {0} needs --definition FILE with a table [channels.{0}]",
                          options.sensor)
            : fmt::format("--sensor {0}: {1} has no [channels.{0}]", options.sensor,
                          options.definition));
  }
  return *found;
}

analysis::CertificateRecord real_record(const DeviceTestOptions& options, const DeviceSetup& setup,
                                        const analysis::Excitation& excitation,
                                        std::vector<analysis::CertificatePart> parts) {
  std::optional<SensorChannel> sensor;
  if (!options.sensor.empty()) {
    sensor.emplace(sensor_of(options, setup), options.sensor_axes);
    using analysis::CertificatePart;
    parts.insert(parts.begin() + 1, {CertificatePart::kGrid, CertificatePart::kFrequency});
  }
  const DeviceUnderTest bench = make_bench(options, setup);
  CertificateTask task(*bench.device, sensor ? &*sensor : nullptr, excitation, std::move(parts));
  realtime::ServoLoop loop(realtime::ClockKind::kReal, kDeviceTestRate);
  run_certificate(task, *bench.device, loop);
  if (interrupted()) {
    throw RunError("interrupted; no certificate was written");
  }
  if (task.fault() != device::Fault::kNone) {
    throw RunError(fmt::format("the certificate ended early: {}{}{}",
                               device::describe(task.fault()), *task.trouble() != '\0' ? "; " : "",
                               task.trouble()));
  }
  return task.record();
}

/// Share of the device's force that a certificate commands.
constexpr double kForceShare = 0.4;

}  // namespace

int certify_device(const DeviceTestOptions& options, const DeviceSetup& setup) {
  using analysis::CertificatePart;
  constexpr double kMostMass = 5.0;
  if (!(options.mass >= 0.0 && options.mass <= kMostMass)) {
    throw InputError(
        fmt::format("--mass is {}; allowed: a number from 0 to {} [kg]", options.mass, kMostMass));
  }
  if (!options.sensor.empty() && options.name == "virtual") {
    throw InputError("the virtual device has a simulated force sensor; leave --sensor out");
  }
  if (options.name == "mouse") {
    throw InputError("a mouse gives no force, so that it has no certificate");
  }
  std::vector<CertificatePart> parts{CertificatePart::kRest, CertificatePart::kFree};
  if (options.mass > 0.0) {
    parts.push_back(CertificatePart::kLoaded);
  }
  parts.push_back(CertificatePart::kWall);
  const bool is_virtual = options.name == "virtual";
  constexpr double kOwnForce = 3.0;  // of a device that another program added [N]
  const device::VendorDevice* vendor = device::vendor_device(options.name);
  const double most = is_virtual          ? setup.electronics.max_force
                      : vendor != nullptr ? vendor->limits(setup.vendor).max_force
                                          : kOwnForce;
  const analysis::Excitation excitation(kDeviceTestRate, kForceShare * most);
  analysis::CertificateRecord record = is_virtual
                                           ? virtual_record(options, setup, excitation, parts)
                                           : real_record(options, setup, excitation, parts);
  record.mass = options.mass;
  const analysis::CertificateResult result = identify_device(record, excitation);
  write_certificate(record, result, options.certificate);
  for (const std::string& line :
       analysis::lines_of(certificate_findings(record, result).front().findings)) {
    fmt::print("{}\n", line);
  }
  fmt::print("{}{}\n", record.simulated ? "simulated; " : "",
             (std::filesystem::path(options.certificate) / "certificate.html").string());
  return 0;
}

}  // namespace haptrial::experiments
