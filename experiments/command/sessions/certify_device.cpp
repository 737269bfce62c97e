#include "experiments/command/sessions/certify_device.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "analysis/device/certificate_report.h"
#include "core/base/error.h"
#include "core/device/sensed_mount.h"
#include "experiments/command/sessions/certificate_task.h"
#include "experiments/command/sessions/sensor_channel.h"
#include "experiments/control/signals.h"

namespace haptrial::experiments {
namespace {

using analysis::CertificatePart;

/// A virtual part's motors and the mass that they move.
struct VirtualPart {
  protocols::DeviceArm arm;
  device::VirtualDeviceParameters electronics;
  device::SensedMountParameters mount;
};

VirtualPart virtual_part(const protocols::DeviceArm& arm, const DeviceTestOptions& options,
                         const DeviceSetup& setup) {
  VirtualPart made{arm, setup.electronics, {}};
  made.electronics.faults = arm.faults.value_or(setup.electronics.faults);
  made.mount = {.mass = arm.handle_mass.value_or(setup.hand.handle_mass),
                .friction = setup.hand.coulomb_friction,
                .noise = made.electronics.faults.sensor_noise,
                .added_mass = load_of(options, arm)};
  return made;
}

/// The virtual device's faults, for the page of its certificate.
std::vector<std::string> planted(const VirtualPart& part) {
  const device::MotorFaults& f = part.electronics.faults;
  const device::PartUnits units = part.arm.units();
  const double mass = part.mount.mass;
  const bool turns = part.arm.part == device::Part::kRotation;
  return {
      fmt::format("gain {}, dead zone {:.4g} {}, offset {:.4g} {}", f.gain,
                  units.newton * f.dead_zone, units.force, units.newton * f.gravity_error,
                  units.force),
      fmt::format("cogging {:.4g} {} every {:.4g} {}", units.newton * f.cogging, units.force,
                  units.metre * f.cogging_period, units.place),
      f.resonance > 0.0
          ? fmt::format("resonance {} Hz, damping {}", f.resonance, f.resonance_damping)
          : "no resonance",
      fmt::format("delay {} ms, friction {:.4g} {}, inertia {:.4g} {}",
                  1e3 * part.electronics.force_delay / kDeviceTestRate,
                  units.newton * part.mount.friction, units.force,
                  turns ? mass * part.arm.radius * part.arm.radius : mass, turns ? "kg·m²" : "kg")};
}

/// The certificate of a part of the virtual device, whose handle a mount holds, moves and lets go.
analysis::CertificateRecord virtual_record(const VirtualPart& part,
                                           const analysis::Excitation& excitation,
                                           std::vector<CertificatePart> parts,
                                           bool without_sensor) {
  device::SensedMount mount(part.mount, 1 + static_cast<std::uint64_t>(part.arm.part));
  device::VirtualDevice device(part.electronics, mount, kDeviceTestRate);
  const double reach = reach_of(part.arm.part, part.arm.radius, part.electronics.workspace_radius);
  if (!without_sensor) {
    parts.insert(parts.begin() + 1,
                 {CertificatePart::kGrid, CertificatePart::kFrequency, CertificatePart::kMove});
  }
  CertificateTask task(device, without_sensor ? nullptr : &mount, excitation, parts,
                       [&mount, &excitation, reach](CertificatePart now, long tick) {
                         mount.carry(now == CertificatePart::kLoaded);
                         if (now == CertificatePart::kFree || now == CertificatePart::kLoaded ||
                             now == CertificatePart::kWall) {
                           mount.release();
                         } else {
                           mount.hold(excitation.position(now, tick + 1, reach));
                         }
                       });
  realtime::ServoLoop loop(realtime::ClockKind::kSimulated, kDeviceTestRate);
  loop.run(task);
  analysis::CertificateRecord record = task.record();
  if (task.fault() != device::Fault::kNone) {
    throw RunError(fmt::format("the certificate ended early: {}", device::describe(task.fault())));
  }
  record.of = part.arm.part;
  record.radius = part.arm.radius;
  record.mass = part.mount.added_mass;
  record.plant = planted(part);
  return record;
}

/// Certificates of the virtual tip, and of the rotation and grip that the definition gives it.
/// @throws RunError if the simulated device has a fault
std::vector<analysis::PartCertificate> virtual_certificates(const DeviceTestOptions& options,
                                                            const DeviceSetup& setup) {
  std::vector<protocols::DeviceArm> arms = setup.arms;
  if (arms.empty()) {
    arms.push_back({});
  }
  std::erase_if(arms, [](const auto& arm) { return arm.of != 0; });
  std::vector<analysis::PartCertificate> all;
  for (const protocols::DeviceArm& arm : arms) {
    const VirtualPart part = virtual_part(arm, options, setup);
    const bool is_tip = arm.part == device::Part::kTip;
    const double most = is_tip ? part.electronics.max_force
                               : std::min(part.electronics.max_force, arm.limits.max_force);
    const analysis::DrivenAxes axes =
        arm.part == device::Part::kGrip ? analysis::DrivenAxes{0} : analysis::DrivenAxes{0, 1, 2};
    const analysis::Excitation excitation =
        excitation_of(arm, axes, most, part.electronics.workspace_radius);
    all.push_back(
        analysis::identify_part(virtual_record(part, excitation, parts_without_sensor(options, arm),
                                               options.without_sensor),
                                excitation));
  }
  return all;
}

/// The sentences that ask a person to prepare a part of the measurement.
struct Prompts {
  const char *rest, *free, *loaded, *wall, *grid;
};

const Prompts& prompts_of(device::Part part) {
  static const Prompts tip{
      "keep the handle still: put it down, or clamp it",
      "let the handle go, with free space around it: the device moves it",
      "fix the known mass to the handle and let it go: the device moves it",
      "let the handle go, with free space around it: the device presses it against walls",
      "clamp the handle to the force sensor in the middle of the workspace",
  };
  static const Prompts rotation{
      "rotation: hold the handle's tip and keep its rotation still, in the middle of its turns",
      "rotation: let it turn freely: the device turns it",
      "",
      "rotation: let it turn freely: the device presses it against springs",
      "rotation: clamp the handle to the torque sensor in the middle of its turns",
  };
  static const Prompts grip{
      "grip: keep it still and half open",
      "grip: let it go, half open: the device moves it",
      "",
      "grip: let it go, half open: the device presses it against springs",
      "grip: clamp it to the force sensor, half open",
  };
  return part == device::Part::kRotation ? rotation : part == device::Part::kGrip ? grip : tip;
}

const char* certificate_prompt(const Prompts& prompts, analysis::CertificatePart part) {
  switch (part) {
    case analysis::CertificatePart::kRest:
      return prompts.rest;
    case analysis::CertificatePart::kFree:
      return prompts.free;
    case analysis::CertificatePart::kLoaded:
      return prompts.loaded;
    case analysis::CertificatePart::kWall:
      return prompts.wall;
    case analysis::CertificatePart::kGrid:
      return prompts.grid;
    case analysis::CertificatePart::kFrequency:
      return "leave the handle clamped";
    case analysis::CertificatePart::kMove:
    case analysis::CertificatePart::kDone:
      break;
  }
  return "";
}

/// Runs the parts on a real clock; each begins ten seconds after the person was told.
void run_certificate(CertificateTask& task, device::Device& device, realtime::ServoLoop& loop,
                     const Prompts& prompts) {
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
      const bool loaded = told == CertificatePart::kLoaded;
      told = task.part();
      begin = std::chrono::steady_clock::now() + std::chrono::seconds(kCountdown);
      fmt::print("-> {}{}; it begins in {} s\n", loaded ? "take the mass off and " : "",
                 certificate_prompt(prompts, *told), kCountdown);
      std::fflush(stdout);
    }
    if (std::chrono::steady_clock::now() >= begin) {
      task.start();
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  servo.join();
}

/// The channel that an option names. @throws InputError if the definition has no such channel
const channel::ChannelOptions& sensor_of(const char* option, const std::string& name,
                                         const DeviceTestOptions& options,
                                         const DeviceSetup& setup) {
  const auto found = std::ranges::find(setup.channels, name, &channel::ChannelOptions::name);
  if (found == setup.channels.end()) {
    throw InputError(
        options.definition.empty()
            ? fmt::format("{0} {1} needs --definition FILE with a table [channels.{1}]", option,
                          name)
            : fmt::format("{0} {1}: {2} has no [channels.{1}]", option, name, options.definition));
  }
  return *found;
}

/// The channel that measures a part; null: none does.
const channel::ChannelOptions* sensor_of(device::Part part, const DeviceTestOptions& options,
                                         const DeviceSetup& setup) {
  if (part == device::Part::kGrip) {
    return options.grip_sensor.empty()
               ? nullptr
               : &sensor_of("--grip-sensor", options.grip_sensor, options, setup);
  }
  if (options.sensor.empty()) {
    return nullptr;
  }
  const channel::ChannelOptions& found = sensor_of("--sensor", options.sensor, options, setup);
  return part == device::Part::kTip || measures(found, part) ? &found : nullptr;
}

analysis::CertificateRecord real_record(const DeviceTestOptions& options, const DeviceSetup& setup,
                                        const analysis::Excitation& excitation,
                                        const protocols::DeviceArm& arm, device::Device& device) {
  std::vector<CertificatePart> parts = parts_without_sensor(options, arm);
  std::optional<SensorChannel> sensor;
  if (const channel::ChannelOptions* own = sensor_of(arm.part, options, setup)) {
    sensor.emplace(*own, options.sensor_axes, channel::Channel::Now{}, arm.part, arm.radius);
    parts.insert(parts.begin() + 1, {CertificatePart::kGrid, CertificatePart::kFrequency});
  }
  CertificateTask task(device, sensor ? &*sensor : nullptr, excitation, std::move(parts), {},
                       arm.part, arm.radius);
  realtime::ServoLoop loop(realtime::ClockKind::kReal, kDeviceTestRate);
  run_certificate(task, device, loop, prompts_of(arm.part));
  if (interrupted()) {
    throw RunError("interrupted; no certificate was written");
  }
  if (task.fault() != device::Fault::kNone) {
    throw RunError(fmt::format("the certificate ended early: {}{}{}",
                               device::describe(task.fault()), *task.trouble() != '\0' ? "; " : "",
                               task.trouble()));
  }
  analysis::CertificateRecord record = task.record();
  record.mass = load_of(options, arm);
  return record;
}

/// The parts for which the device has motors, with radius of the definition if it states one.
std::vector<protocols::DeviceArm> driven_arms(const device::DeviceInfo& info,
                                              const DeviceSetup& setup) {
  constexpr double kFingers = 0.03;  // [m]
  std::vector<protocols::DeviceArm> arms;
  for (const device::Part part :
       {device::Part::kTip, device::Part::kRotation, device::Part::kGrip}) {
    protocols::DeviceArm arm;
    arm.part = part;
    arm.radius = part == device::Part::kRotation ? kFingers : 1.0;
    const auto stated = std::ranges::find_if(
        setup.arms, [&](const auto& one) { return one.part == part && one.of == 0; });
    if (stated != setup.arms.end()) {
      arm.radius = stated->radius;
    }
    const bool drives = device::part_axes(part, info).maxCoeff() > 0.0 &&
                        device::most_force(part, info, arm.radius) > 0.0;
    if (drives || part == device::Part::kTip) {
      arms.push_back(arm);
    }
  }
  return arms;
}

analysis::DrivenAxes axes_of(device::Part part, const device::DeviceInfo& info) {
  const Eigen::Vector3d driven = device::part_axes(part, info);
  analysis::DrivenAxes axes;
  for (int axis = 0; axis < 3; ++axis) {
    if (driven[axis] > 0.0) {
      axes.push_back(axis);
    }
  }
  return axes;
}

std::vector<analysis::PartCertificate> real_certificates(const DeviceTestOptions& options,
                                                         const DeviceSetup& setup) {
  constexpr double kOwnForce = 3.0;  // of a device that another program added [N]
  const device::VendorDevice* vendor = device::vendor_device(options.name);
  const double most_at_tip = vendor != nullptr ? vendor->limits(setup.vendor).max_force : kOwnForce;
  const DeviceUnderTest bench = make_bench(options, setup);
  const device::DeviceInfo& info = bench.device->info();
  std::vector<analysis::PartCertificate> all;
  for (const protocols::DeviceArm& arm : driven_arms(info, setup)) {
    const double most = arm.part == device::Part::kTip
                            ? most_at_tip
                            : device::most_force(arm.part, info, arm.radius);
    const analysis::Excitation excitation =
        excitation_of(arm, axes_of(arm.part, info), most, info.workspace_radius);
    all.push_back(analysis::identify_part(
        real_record(options, setup, excitation, arm, *bench.device), excitation));
  }
  return all;
}

void check_options(const DeviceTestOptions& options) {
  constexpr double kMostMass = 5.0;  // [kg]
  if (!(options.mass >= 0.0 && options.mass <= kMostMass)) {
    throw InputError(
        fmt::format("--mass is {}; allowed: a number from 0 to {} [kg]", options.mass, kMostMass));
  }
  if (options.name == "virtual" && !(options.sensor.empty() && options.grip_sensor.empty())) {
    throw InputError(
        "the virtual device has simulated sensors; leave --sensor and --grip-sensor out");
  }
  if (options.name == "mouse") {
    throw InputError("a mouse gives no force, so that it has no certificate");
  }
}

}  // namespace

int certify_device(const DeviceTestOptions& options, const DeviceSetup& setup) {
  check_options(options);
  if (options.name != "virtual") {  // before the device opens
    sensor_of(device::Part::kTip, options, setup);
    sensor_of(device::Part::kGrip, options, setup);
  }
  const std::vector<analysis::PartCertificate> parts = options.name == "virtual"
                                                           ? virtual_certificates(options, setup)
                                                           : real_certificates(options, setup);
  write_certificate(parts, options.certificate);
  for (const analysis::FindingList& list : certificate_findings(parts)) {
    if (list.name.ends_with("summary")) {
      fmt::print("{}\n", list.heading);
      for (const std::string& line : analysis::lines_of(list.findings)) {
        fmt::print("  {}\n", line);
      }
    }
  }
  fmt::print("{}{}\n", parts.front().record.simulated ? "simulated; " : "",
             (std::filesystem::path(options.certificate) / "certificate.html").string());
  return 0;
}

}  // namespace haptrial::experiments
