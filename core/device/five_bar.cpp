#include "core/device/five_bar.h"

#include <Eigen/LU>
#include <cmath>

namespace haptrial::device {
namespace {

using Eigen::Vector2d;

constexpr double kLeastSine = 0.17364817766693033;  // of 10°, between the forearms

/// Direction of an arm, and of its end when the angle grows.
Vector2d along(double angle) { return {std::cos(angle), std::sin(angle)}; }
Vector2d across(double angle) { return {-std::sin(angle), std::cos(angle)}; }

}  // namespace

FiveBarPose solve_five_bar(const FiveBar& bars, const Vector2d& angles) noexcept {
  FiveBarPose pose;
  const Vector2d a = bars.arm * along(angles[0]);
  const Vector2d b = Vector2d(bars.base, 0.0) + bars.arm * along(angles[1]);
  const Vector2d half = 0.5 * (b - a);
  const double rise = bars.forearm * bars.forearm - half.squaredNorm();
  const double length = half.norm();
  if (!(rise > 0.0 && length > 0.0)) {  // apart, or on each other; not finite
    return pose;
  }
  const Vector2d handle = a + half + std::sqrt(rise) / length * Vector2d(-half.y(), half.x());
  const Vector2d u = handle - a;
  const Vector2d v = handle - b;
  const double cross = u.x() * v.y() - u.y() * v.x();
  if (!(std::abs(cross) >= kLeastSine * bars.forearm * bars.forearm)) {
    return pose;
  }
  Eigen::Matrix2d lengths;
  lengths << u.x(), u.y(), v.x(), v.y();
  const Vector2d pushed{u.dot(bars.arm * across(angles[0])), v.dot(bars.arm * across(angles[1]))};
  pose.regular = true;
  pose.handle = handle;
  pose.jacobian = lengths.inverse() * pushed.asDiagonal();
  return pose;
}

}  // namespace haptrial::device
