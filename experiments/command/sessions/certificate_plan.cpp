#include "experiments/command/sessions/certificate_plan.h"

#include <algorithm>

namespace haptrial::experiments {
namespace {

/// Share of the device's force that a certificate commands.
constexpr double kForceShare = 0.4;

}  // namespace

double reach_of(device::Part part, double radius, double workspace_radius) {
  constexpr double kTurn = 1.0;       // [rad]
  constexpr double kOpening = 0.008;  // [m]
  switch (part) {
    case device::Part::kRotation:
      return std::min(kTurn * radius, 0.5 * workspace_radius);
    case device::Part::kGrip:
      return std::min(kOpening, 0.5 * workspace_radius);
    case device::Part::kTip:
      break;
  }
  return 0.5 * workspace_radius;
}

analysis::Excitation excitation_of(const protocols::DeviceArm& arm,
                                   const analysis::DrivenAxes& axes, double most,
                                   double workspace_radius) {
  const double force = kForceShare * most;
  return arm.part == device::Part::kTip
             ? analysis::Excitation(kDeviceTestRate, force)
             : analysis::Excitation(kDeviceTestRate, force, axes,
                                    reach_of(arm.part, arm.radius, workspace_radius));
}

double load_of(const DeviceTestOptions& options, const protocols::DeviceArm& arm) {
  return arm.part == device::Part::kTip ? options.mass : 0.0;
}

std::vector<analysis::CertificatePart> parts_without_sensor(const DeviceTestOptions& options,
                                                            const protocols::DeviceArm& arm) {
  std::vector<analysis::CertificatePart> parts{analysis::CertificatePart::kRest,
                                               analysis::CertificatePart::kFree};
  if (load_of(options, arm) > 0.0) {
    parts.push_back(analysis::CertificatePart::kLoaded);
  }
  parts.push_back(analysis::CertificatePart::kWall);
  return parts;
}

}  // namespace haptrial::experiments
