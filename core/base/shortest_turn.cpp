#include "core/base/shortest_turn.h"

#include <cmath>

namespace haptrial {
namespace {

constexpr double kNearlyOpposite = -0.9;  // cosine, from which 1 + cosine loses digits

/// Unit vector perpendicular to a, along `axis` as far as that has digits.
Eigen::Vector3d perpendicular(const Eigen::Vector3d& a, const Eigen::Vector3d& axis) {
  const Eigen::Vector3d across = axis - a.dot(axis) * a;
  const bool known = across.norm() > 0.5 * axis.norm();
  return known ? across.normalized() : a.unitOrthogonal();
}

}  // namespace

Eigen::Quaterniond shortest_turn(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  const Eigen::Vector3d a = from.normalized();
  const Eigen::Vector3d b = to.normalized();
  const double cosine = b.dot(a);
  Eigen::Quaterniond turn;
  if (cosine > kNearlyOpposite) {
    const double doubled = std::sqrt((1.0 + cosine) * 2.0);  // 2 cos(angle / 2)
    turn.vec() = a.cross(b) * (1.0 / doubled);
    turn.w() = doubled * 0.5;
  } else {
    turn.vec() = perpendicular(a, a.cross(b)) * ((a - b).norm() * 0.5);
    turn.w() = (a + b).norm() * 0.5;
  }
  return turn;
}

}  // namespace haptrial
