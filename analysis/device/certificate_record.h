#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "analysis/device/excitation.h"
#include "core/device/device.h"

namespace haptrial::analysis {

/// One part of a certificate's measurement, a row a tick from its beginning, all of one length and
/// in W.
struct PartRecord {
  std::vector<Eigen::Vector3d> command;   // written on the tick, after it was read [N]
  std::vector<Eigen::Vector3d> position;  // [m]
  std::vector<Eigen::Vector3d> velocity;  // as the device states it [m/s]
  std::vector<Eigen::Vector3d> measured;  // force on the hand; empty without a sensor [N]
  // When each of them was measured, by the sensor's clock: the same time is the same measurement.
  // Empty: each is another one, of its tick [s].
  std::vector<double> measured_at;
};

/// A wall that the handle was pressed against.
struct WallStep {
  double stiffness;  // [N/m]
  bool passive;      // it neither swung on nor gave energy
  bool met{true};    // it was let go in front of the wall and came to it; else nothing is known
};

/// The record of a certificate's measurement, of one part of the handle: places and forces of a
/// rotation or a grip are those at the fingers (core/device/handle_part.h).
struct CertificateRecord {
  std::string device;
  device::Part of{device::Part::kTip};
  double radius{1.0};        // of the fingers about the axis of a rotation [m]
  DrivenAxes axes{0, 1, 2};  // those of the excitation
  bool simulated{false};
  double sensor_age{0.0};    // mean time from the measurement of a force to its tick [s]
  double stated_noise{0.0};  // of the sensor; 0: not stated [N]
  double mass{0.0};          // known mass on the handle in kLoaded; 0: none [kg]
  std::array<PartRecord, static_cast<std::size_t>(CertificatePart::kDone)> parts;
  std::vector<WallStep> walls;
  std::vector<std::string> plant;  // faults of a virtual device, a line each

  const PartRecord& part(CertificatePart which) const {
    return parts[static_cast<std::size_t>(which)];
  }
  bool has_sensor(CertificatePart which) const { return !part(which).measured.empty(); }
};

/// Gives each tick of a part the force that was measured nearest to it, of all that its ticks read.
/// @param tick_at  when each tick was, by the clock of part.measured_at and as many [s]
/// @returns the mean time from a measurement to its tick [s]; below 0 if they came after it
double align_forces(PartRecord& part, const std::vector<double>& tick_at);

}  // namespace haptrial::analysis
