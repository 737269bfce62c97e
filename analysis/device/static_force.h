#pragma once

#include <vector>

#include "analysis/device/certificate_record.h"
#include "analysis/device/interval.h"

namespace haptrial::analysis {

/// Static force along one direction and its opposite.
struct DirectionForce {
  Eigen::Vector3d direction;  // unit vector in W
  Interval gain, opposite_gain;
  Interval dead_zone;  // [N]
};

/// Static force at one level, over all directions.
struct LevelForce {
  double level;    // commanded > 0 [N]
  Interval error;  // mean of measured - commanded, along the command [N]
  double largest;  // in size, of a direction [N]
};

/// Static force of a device:
///
///     F · d = o(d) + gain · max(L - dead_zone, 0)
///
/// for a force L held in each of 26 directions d. Hysteresis has no share in it, because each level
/// is reached from below and from above.
struct StaticForce {
  Interval gain;       // of all directions
  Interval dead_zone;  // [N]
  std::vector<DirectionForce> directions;
  std::vector<LevelForce> levels;
  std::vector<double> commanded, measured;  // of every hold, along the command [N]
};

/// @param record  with a sensor in kGrid
StaticForce identify_static_force(const CertificateRecord& record, const Excitation& excitation);

}  // namespace haptrial::analysis
