#pragma once

#include <optional>
#include <vector>

#include "analysis/device/certificate_record.h"
#include "analysis/device/interval.h"

namespace haptrial::analysis {

/// Force of an unpowered device on a hand that moves it along one axis:
///
///     F = offset - friction sgn v + cogging cos(2 pi x / period - phase) - inertia a
struct AxisMotion {
  Interval offset;    // gravity that is not balanced, and the sensor's bias [N]
  Interval friction;  // [N]
  Interval inertia;   // [kg]
  std::optional<Interval> cogging, period;  // if any was found [N], [m]
  double least_cogging{0.0};                // amplitude that would have been found [N]
  std::vector<double> position;             // of the slow movement, in bins [m]
  std::vector<double> forward, backward;    // mean force there; NaN: none [N]
};

/// Motion along each driven axis; empty if the handle was not moved far enough.
/// @param record  with a sensor in kMove
std::vector<AxisMotion> identify_motion(const CertificateRecord& record,
                                        const Excitation& excitation);

}  // namespace haptrial::analysis
