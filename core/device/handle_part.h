#pragma once

#include <Eigen/Geometry>

#include "core/device/device.h"

namespace haptrial::device {

// A rotation and a grip are driven as a tip is: as a place, a velocity and a force at the fingers.
// A rotation is the arc that fingers travel which hold the handle at a radius r from its axis, and
// its force the one along this arc:
//
//     place = r phi,    velocity = r omega,    torque = r force
//
// with the rotation vector phi, whose direction is the axis and whose length the angle. So limits,
// ramps, guards and laws in m and N hold for what fingers feel, whatever moves them. A grip has its
// opening along x.

/// The rotation vector of an orientation, of all that differ by whole turns the one next to
/// `before` [rad], so that a handle can be turned on and on. Without a finite `before`, the
/// shortest.
Eigen::Vector3d rotation_near(const Eigen::Quaterniond& orientation,
                              const Eigen::Vector3d& before) noexcept;

/// The part's place and velocity as a tip.
/// @param whole   of the device
/// @param radius  of the fingers about the axis; of a rotation > 0 [m]
/// @param before  the part's place a tick ago [m]
PointState part_state(Part part, const DeviceReading& whole, double radius,
                      const Eigen::Vector3d& before) noexcept;

/// The axes of W along which the part gives forces (DeviceInfo::force_axes).
Eigen::Vector3d part_axes(Part part, const DeviceInfo& info) noexcept;

/// Puts the part's force in its place in a wrench. @param radius  as above
void put_force(Part part, const Eigen::Vector3d& force, double radius, Wrench& wrench) noexcept;

/// The most that the device gives there [N].
double most_force(Part part, const DeviceInfo& info, double radius) noexcept;

/// The units in which people state a part's forces and places, and what 1 N and 1 m at the fingers
/// are in them.
struct PartUnits {
  const char* force{"N"};
  double newton{1.0};
  const char* place{"m"};
  double metre{1.0};
};
PartUnits units_of(Part part, double radius) noexcept;

/// The name of a part: "rotation".
const char* part_word(Part part) noexcept;
/// The name of the force that it gives: "torque" of a rotation.
const char* force_word(Part part) noexcept;

}  // namespace haptrial::device
