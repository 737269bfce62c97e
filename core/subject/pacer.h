#pragma once

#include <Eigen/Core>

#include "core/base/definition/schema_forward.h"
#include "core/base/random.h"
#include "core/subject/hand_parameters.h"
#include "core/subject/noise.h"

namespace haptrial::subject {

template <class Person>
struct Population;

/// How somebody moves along a path at their own pace. Sources: docs/algorithms/virtual-subject.md.
struct PaceParameters {
  double pace{0.016};       // along a path of the reference curvature [m/s]
  double variability{0.1};  // spread of the intended speed within a pass, log units
  double correlation{1.0};  // time over which it is alike [s]
};

/// The keys of [pace], which say how each parameter varies over people. Their streams are their
/// own, so that nothing else about a person changes.
const Schema<Population<PaceParameters>>& pace_schema();

/// The arm that carries a hand along a path. Its intended speed follows the two-thirds power law
///
///     v = pace · exp(noise) · (curvature / reference)^(-1/3),  within half and twice
///
/// (Lacquaniti, Terzuolo and Viviani 1983), with the curvature seen as the turn of the path's
/// direction over the last millimetres. The force is what the hand's own drag takes at that speed,
/// and a slow correction of the speed that is felt.
class Pacer {
 public:
  Pacer(const PaceParameters& person, const HandParameters& hand, RandomStream random,
        double step) noexcept;

  // Servo thread.
  void begin() noexcept;
  /// @param direction  of the path where the hand is, unit length
  /// @param velocity   of the hand along it, as felt now [m/s]
  /// @returns the force of the arm in W [N]
  Eigen::Vector3d drive(const Eigen::Vector3d& direction, double velocity) noexcept;

 private:
  PaceParameters person_;
  double drag_;  // of the hand at a steady speed [N·s/m]
  double step_;  // [s]
  RandomStream random_;
  SmoothNoise noise_;
  double noise_now_{0.0};
  double noise_next_{0.0};
  double noise_age_{0.0};   // since noise_now_ [s]
  double correction_{0.0};  // [N]
  double intended_{0.0};
  double time_{0.0};                                // since the start of the pass [s]
  Eigen::Vector3d trend_{Eigen::Vector3d::Zero()};  // the path's direction over the last way
  bool begun_{false};
};

}  // namespace haptrial::subject
