#pragma once

#include <optional>
#include <vector>

#include "analysis/device/free_motion.h"
#include "analysis/device/frequency_response.h"
#include "analysis/device/motion_force.h"
#include "analysis/device/static_force.h"

namespace haptrial::analysis {

/// Noise and resolution of a handle that is held still.
struct RestNoise {
  std::optional<Interval> sensor;  // standard deviation, each axis [N]
  Interval position;               // [m]
  Interval velocity;               // [m/s]
  double resolution{0.0};          // smallest step of a position; 0: finer than can be told [m]
};

/// The largest stiffness that stayed passive and the smallest that did not.
struct WallBracket {
  double passive{0.0};  // 0: none did [N/m]
  double active{0.0};   // 0: all were passive [N/m]
  bool met{true};       // the handle came to every wall that was tried
};

/// The figures of a certificate; a part is empty if its measurement is missing.
struct CertificateResult {
  std::optional<StaticForce> statics;
  std::vector<AxisResponse> response;  // (driven axes)
  std::vector<AxisMotion> motion;      // (driven axes)
  std::vector<FreeMotion> free;        // (driven axes)
  std::vector<FreeMotion> loaded;      // likewise, with the known mass
  RestNoise rest;
  std::optional<WallBracket> wall;
};

/// Everything that the record shows.
CertificateResult identify_device(const CertificateRecord& record, const Excitation& excitation);

}  // namespace haptrial::analysis
