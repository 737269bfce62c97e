#pragma once

#include <Eigen/Core>

#include "core/base/definition/schema_forward.h"

namespace haptrial::device {

/// Faults of a virtual device's motors and transmission; the defaults are those of a perfect one.
/// Friction and inertia are those of the load on the handle (HandlePhysics), so [hand] has them.
struct MotorFaults {
  double gain{1.0};               // force given per force commanded > 0
  double dead_zone{0.0};          // a shorter command gives no force, a longer one that less [N]
  double resonance{0.0};          // of the transmission, 0: it is rigid [Hz]
  double resonance_damping{0.1};  // share of critical damping, 0.001 to 2
  double cogging{0.0};            // amplitude of a force that depends on position, each axis [N]
  double cogging_period{0.002};   // > 0 [m]
  double gravity_error{0.0};      // upward force that is left when no force is commanded [N]
  double sensor_noise{0.02};      // standard deviation of the force sensor of a certificate [N]
};

/// The keys of [device.faults].
const Schema<MotorFaults>& motor_faults_schema();

/// Turns commanded forces into those that faulty motors give:
///
///     u = gain · max(|f| - dead_zone, 0) f / |f|
///     y'' = w² (u - y) - 2 z w y'            w = 2 pi resonance, z = resonance_damping
///     F = y - cogging sin(2 pi p / cogging_period) + gravity_error e_y     each axis p of position
///
/// u is held over a tick, for which y is exact; y = u without a resonance. Servo thread: no
/// allocation, lock, I/O or throw.
class FaultyMotors {
 public:
  /// @param period  of the servo loop > 0 [s]
  /// @throws std::invalid_argument naming the parameter that breaks its bound.
  FaultyMotors(const MotorFaults& faults, double period);

  /// @param command   in W [N].  @param position  of the handle in W [m]
  /// @returns the force at the end of a tick that gives `command` [N].
  Eigen::Vector3d force(const Eigen::Vector3d& command, const Eigen::Vector3d& position) noexcept;

 private:
  MotorFaults faults_;
  Eigen::Matrix2d step_{Eigen::Matrix2d::Zero()};  // of (y - u, y') over a tick
  Eigen::Matrix<double, 2, 3> state_{Eigen::Matrix<double, 2, 3>::Zero()};  // (y, y'), each axis
};

/// The exact step over `period` [s] of (y, y') towards a held u, as a matrix on (y - u, y').
/// @param resonance  > 0 [Hz].  @param damping  share of critical damping > 0
Eigen::Matrix2d resonator_step(double resonance, double damping, double period);

}  // namespace haptrial::device
