#pragma once

#include <optional>
#include <vector>

#include "analysis/device/certificate_record.h"
#include "analysis/device/interval.h"

namespace haptrial::analysis {

/// Figures that motion alone tells of a handle that commanded forces move along one axis:
///
///     a = mobility · (R(dead(f))(t - delay) - friction sgn v + cogging cos(2 pi x / period -
///     phase)
///                     + offset)
///
/// with dead() the command behind a dead zone and R() a resonance of second order. Forces are in
/// commanded newtons: how many real ones these are takes a force sensor or a known mass.
struct FreeMotion {
  Interval mobility;                        // gain / inertia [1/kg]
  Interval delay;                           // from a command to the beginning of its force [s]
  Interval friction;                        // [commanded N]
  Interval dead_zone;                       // [commanded N]
  Interval offset;                          // [commanded N]
  std::optional<Interval> resonance;        // natural frequency, if motion shows it clearly [Hz]
  std::optional<Interval> damping;          // share of critical damping
  std::optional<Interval> bandwidth;        // gain falls to 1/√2 of that at rest [Hz]
  std::optional<Interval> cogging, period;  // if any was found [commanded N], [m]
};

/// Motion along each driven axis; empty if the handle did not move far enough.
/// @param part  kFree or kLoaded
std::vector<FreeMotion> identify_free_motion(const CertificateRecord& record,
                                             const Excitation& excitation, CertificatePart part);

/// Gain and inertia from motion without and with a known mass on the handle, along one axis.
struct WeighedMotion {
  Interval gain;
  Interval inertia;  // [kg]
};
WeighedMotion weigh(const FreeMotion& free, const FreeMotion& loaded, double mass);

}  // namespace haptrial::analysis
