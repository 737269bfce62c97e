#pragma once

#include <array>

#include "core/base/random.h"
#include "core/device/force_sensor.h"
#include "core/device/handle_physics.h"

namespace haptrial::device {

/// The handle of a virtual device on its own, in a mount with a force sensor or let go.
struct SensedMountParameters {
  double mass{0.22};       // moving mass of the device at the handle > 0 [kg]
  double friction{0.1};    // of the device, along each axis >= 0 [N]
  double noise{0.02};      // standard deviation of the sensor, each axis >= 0 [N]
  double added_mass{0.0};  // on the handle while it is let go >= 0 [kg]
};

/// A mount that holds the handle where it is told to, and measures the force of the device on it,
///
///     F = motors - friction sgn v - mass · a + noise
///
/// or lets it go: then the motors move mass and added_mass against the friction. Motion under a
/// held force is exact. Servo thread: no allocation, lock, I/O or throw.
class SensedMount final : public HandlePhysics, public ForceSensor {
 public:
  /// @throws std::invalid_argument when a parameter is out of its bounds.
  SensedMount(const SensedMountParameters& parameters, std::uint64_t seed);

  /// Holds the handle; the next step ends there. Without jumps: velocity and acceleration follow
  /// from where it was. @param position  in W [m]
  void hold(const Eigen::Vector3d& position) noexcept;
  /// Whether added_mass is on the handle; it is at first.
  void carry(bool added) noexcept { carries_ = added; }
  /// Lets the handle go from where it is, at rest.
  void release() noexcept { held_ = false; }

  PointState step(const Eigen::Vector3d& motor_force, double dt) noexcept override;
  PointState state() const noexcept override { return state_; }
  bool read(MeasuredForce& measured) noexcept override;

 private:
  void follow(const Eigen::Vector3d& motor_force, double dt) noexcept;
  void move_freely(const Eigen::Vector3d& motor_force, double dt) noexcept;

  SensedMountParameters parameters_;
  RandomStream random_;
  PointState state_;
  Eigen::Vector3d goal_{Eigen::Vector3d::Zero()};
  std::array<Eigen::Vector3d, 5> path_;  // the latest positions, the newest first [m]
  MeasuredForce measured_;
  bool held_{true};
  bool carries_{true};
};

}  // namespace haptrial::device
