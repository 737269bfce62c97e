#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "core/base/random.h"
#include "core/subject/hand_parameters.h"
#include "core/subject/smooth_noise.h"
#include "core/subject/subject_parameters.h"

namespace haptrial::subject {

/// How somebody moves along a path at their own pace. Sources: docs/algorithms/virtual-subject.md.
struct PaceParameters {
  double pace{0.016};       // along a path of the reference curvature [m/s]
  double variability{0.1};  // spread of the intended speed within a pass, log units
  double correlation{1.0};  // time over which it is alike [s]
};

/// How that varies over people: every field has its variation.
class PaceHabits {
 public:
  /// Reads a [pace] table in which every field is { median = M, spread = S } or a number.
  explicit PaceHabits(Table& table);
  /// The habits of a person; their own streams, so that nothing else about the person changes.
  PaceParameters draw(std::uint64_t seed) const;

 private:
  Variation pace_, variability_, correlation_;
};

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
  double intended_speed() const noexcept { return intended_; }  // [m/s]

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
