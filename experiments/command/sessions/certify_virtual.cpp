#include "experiments/command/sessions/certify_virtual.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/base/error.h"
#include "core/device/sensed_mount.h"
#include "experiments/command/sessions/certificate_plan.h"
#include "experiments/command/sessions/certificate_task.h"

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

}  // namespace

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

}  // namespace haptrial::experiments
