#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "core/base/definition/schema_forward.h"

namespace haptrial::protocols {

/// A target that moves while it is seen ([targets.NAME], numbers may be formulas):
///
///     p(t) = centre + velocity t + direction Σ_i amplitude_i sin(2π frequency_i t + phase_i)
///
/// with t from the tick on which an interval shows it first.
struct MovingTarget {
  std::string name;
  Eigen::Vector3d centre{Eigen::Vector3d::Zero()};      // [m]
  Eigen::Vector3d velocity{Eigen::Vector3d::Zero()};    // [m/s]
  Eigen::Vector3d direction{Eigen::Vector3d::UnitX()};  // unit
  std::vector<double> frequencies;                      // [Hz]
  std::vector<double> amplitudes;                       // (frequencies) [m]
  std::vector<double> phases;                           // (frequencies) [rad]
  double radius{0.004};                                 // of the circle that is shown; 0: a dot [m]

  /// Servo thread: no allocation or throw. @param t  [s]
  Eigen::Vector3d at(double t) const noexcept;
};

/// Reads [targets], by name. Problems are noted; keys in brackets are optional.
///
///     [centre], [velocity], [direction], [radius]
///     [frequencies], [amplitudes], [phases]   lists of one length; phases may be left out
std::vector<MovingTarget> read_moving_targets(Table& targets);

}  // namespace haptrial::protocols
