#pragma once

#include <Eigen/Core>

#include "core/control/swing_counter.h"
#include "core/device/fault.h"

namespace haptrial::device {

/// Finds forces that go wrong though each alone is allowed.
///
/// - Oscillation at the limit: along one axis the force turned back at least five times, each time
///   by more than half of the limit, from or to more than 0.7 of it, and at most 80 ms after the
///   time before, over 65 ms or more. So 6 Hz and more are found, from 22 Hz on within 120 ms.
/// - Any oscillation: along one axis the force swings by 2 N or more at 15 Hz or more for 0.2 s,
///   and no stimulus accounts for it (SwingCounter). Neither counts while it dies away.
/// - Saturation: for longer than `longest` the force did not leave the limit.
///
/// Servo thread: no allocation, lock, I/O or throw.
class ForceWatch {
 public:
  /// @param limit    of the force > 0 [N]
  /// @param longest  at the limit > 0 [s]
  ForceWatch(double limit, double longest) noexcept;

  /// @param force     that is about to be given [N]
  /// @param stimulus  the part of it that alternates by itself [N]
  /// @returns kOscillation, kSaturation or kNone.
  Fault look(const Eigen::Vector3d& force, const Eigen::Vector3d& stimulus, double dt) noexcept;

  void reset() noexcept { *this = ForceWatch(limit_, longest_); }

 private:
  double limit_;
  double longest_;
  double saturated_for_{0.0};  // [s]
  control::SwingCounter at_limit_;
  control::SwingCounter swings_;
};

/// Purpose of a force, so that any excess can be told. The default is a resting object, which gives
/// back at most what it was given.
struct ForceIntent {
  Eigen::Vector3d drive{
      Eigen::Vector3d::Zero()};                   // velocity of what the force pulls to, in W [m/s]
  Eigen::Vector3d push{Eigen::Vector3d::Zero()};  // the part that is to work on the hand, in W [N]
  /// The part whose course in time is itself the stimulus, such as a vibration: it is no swing, and
  /// a change of stage does not smooth its beginning. In W [N]
  Eigen::Vector3d stimulus{Eigen::Vector3d::Zero()};
  /// Stimulus of the tick before that does not go on. A change of stage smooths its end. In W [N]
  Eigen::Vector3d ended{Eigen::Vector3d::Zero()};
  double stored{0.0};  // in springs of the protocol >= 0 [J]
  double added{0.0};   // of `stored`, by the protocol itself since the tick before [J]
};

/// A passivity observer: the energy that the device has given to the hand beyond what the protocol
/// means to give,
///
///     G = sum of (f - push) · (dp - drive dt) - added + stored
///
/// never rises where what is felt is passive. G may rise by 0.15 J over its lowest value, which is
/// forgotten at 0.15 W: a hold of one tick on a stiff spring and a late force really do generate a
/// little (Colgate and Schenkel 1997). Servo thread: no allocation, lock, I/O or throw.
class EnergyWatch {
 public:
  /// @param force   that acted since the tick before [N]
  /// @param moved   by the tool since the tick before [m]
  /// @param intent  of that force; `stored` and `added` are those of now
  /// @returns whether more energy was generated than is allowed.
  bool look(const Eigen::Vector3d& force, const Eigen::Vector3d& moved, const ForceIntent& intent,
            double dt) noexcept;

  /// G over its lowest value [J].
  double generated() const noexcept { return given_ - lowest_; }

  void reset() noexcept { *this = EnergyWatch{}; }

 private:
  bool begun_{false};
  double work_{0.0};    // (f - push) · (dp - drive dt) so far [J]
  double given_{0.0};   // G [J]
  double lowest_{0.0};  // of G [J]
};

}  // namespace haptrial::device
