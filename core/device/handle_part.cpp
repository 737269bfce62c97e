#include "core/device/handle_part.h"

#include <cmath>
#include <numbers>

namespace haptrial::device {

Eigen::Vector3d rotation_near(const Eigen::Quaterniond& orientation,
                              const Eigen::Vector3d& before) noexcept {
  constexpr double kTurn = 2.0 * std::numbers::pi;
  constexpr double kNoAxis = 1e-9;
  const double sine = orientation.vec().norm();
  const double angle = 2.0 * std::atan2(sine, orientation.w());
  Eigen::Vector3d axis = Eigen::Vector3d::UnitX();
  if (sine > kNoAxis) {
    axis = orientation.vec() / sine;
  } else if (before.norm() > kNoAxis) {
    axis = before.normalized();
  }
  const double turned = before.dot(axis);
  // A place that is no number would make every later one none.
  const double turns = std::isfinite(turned) ? std::round((turned - angle) / kTurn) : 0.0;
  return (angle + kTurn * turns) * axis;
}

PointState part_state(Part part, const DeviceReading& whole, double radius,
                      const Eigen::Vector3d& before) noexcept {
  switch (part) {
    case Part::kRotation:
      return {radius * rotation_near(whole.orientation, before / radius),
              radius * whole.angular_velocity};
    case Part::kGrip:
      return {{whole.opening, 0.0, 0.0}, {whole.opening_speed, 0.0, 0.0}};
    case Part::kTip:
      break;
  }
  return whole.tool;
}

Eigen::Vector3d part_axes(Part part, const DeviceInfo& info) noexcept {
  switch (part) {
    case Part::kRotation:
      return info.torque_axes;
    case Part::kGrip:
      return {info.max_grip_force > 0.0 ? 1.0 : 0.0, 0.0, 0.0};
    case Part::kTip:
      break;
  }
  return info.force_axes;
}

void put_force(Part part, const Eigen::Vector3d& force, double radius, Wrench& wrench) noexcept {
  switch (part) {
    case Part::kRotation:
      wrench.torque = radius * force;
      break;
    case Part::kGrip:
      wrench.grip = force.x();
      break;
    case Part::kTip:
      wrench.force = force;
      break;
  }
}

double most_force(Part part, const DeviceInfo& info, double radius) noexcept {
  switch (part) {
    case Part::kRotation:
      return info.max_torque / radius;
    case Part::kGrip:
      return info.max_grip_force;
    case Part::kTip:
      break;
  }
  return info.max_force;
}

PartUnits units_of(Part part, double radius) noexcept {
  return part == Part::kRotation ? PartUnits{"N·m", radius, "rad", 1.0 / radius} : PartUnits{};
}

const char* part_word(Part part) noexcept {
  switch (part) {
    case Part::kRotation:
      return "rotation";
    case Part::kGrip:
      return "grip";
    case Part::kTip:
      break;
  }
  return "tip";
}

const char* force_word(Part part) noexcept {
  switch (part) {
    case Part::kRotation:
      return "torque";
    case Part::kGrip:
      return "grip force";
    case Part::kTip:
      break;
  }
  return "force";
}

}  // namespace haptrial::device
