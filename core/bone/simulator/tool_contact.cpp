#include "core/bone/simulator/tool_contact.h"

#include <algorithm>
#include <stdexcept>

namespace haptrial::bone {
namespace {

ToolContactParameters accepted(const ToolContactParameters& p) {
  if (!(p.stiffness >= 0.0 && p.damping >= 0.0 && p.force_limit > 0.0)) {
    throw std::invalid_argument(
        "ToolContact: stiffness and damping are at least 0, and the force limit above 0");
  }
  return p;
}

double share(double part, double whole) noexcept {
  return whole > 0.0 ? std::clamp(part / whole, 0.0, 1.0) : 0.0;
}

/// Nearest points of two segments, after Ericson 2005, §5.1.9.
Eigen::Vector3d between_axes(const Rod& first, const Rod& second) noexcept {
  const Eigen::Vector3d u = first.to - first.from;
  const Eigen::Vector3d v = second.to - second.from;
  const Eigen::Vector3d w = first.from - second.from;
  const double uu = u.squaredNorm();
  const double vv = v.squaredNorm();
  const double uv = u.dot(v);
  const double uw = u.dot(w);
  const double vw = v.dot(w);
  double s = share(uv * vw - uw * vv, uu * vv - uv * uv);  // 0 where they are parallel
  const double t = share(s * uv + vw, vv);
  s = share(t * uv - uw, uu);  // as near as it can be to that
  return w + s * u - t * v;
}

}  // namespace

RodDistance distance(const Rod& first, const Rod& second) noexcept {
  const Eigen::Vector3d way = between_axes(first, second);
  const double length = way.norm();
  constexpr double kNothing = 1e-9;  // [m]
  if (length > kNothing) {
    return {length, way / length};
  }
  const Eigen::Vector3d across =
      (first.to - first.from).cross(second.to - second.from).stableNormalized();
  return {length, across.isZero(0.0) ? Eigen::Vector3d(Eigen::Vector3d::UnitY()) : across};
}

ToolContact::ToolContact(const ToolContactParameters& parameters) : p_(accepted(parameters)) {
  wait();
}

void ToolContact::wait() noexcept {
  waits_until_free_ = true;
  sides_.fill(Eigen::Vector3d::Zero());
}

/// The depth that pushes back. A hand that presses on through both axes is let go by degrees, over
/// as far as it took to reach them.
static double pushing_depth(double depth, double reach) noexcept {
  const double beyond = std::clamp((depth - reach) / reach, 0.0, 1.0);
  return depth * (1.0 - beyond * beyond * (3.0 - 2.0 * beyond));
}

ToolContact::Deepest ToolContact::deepest(std::span<const Rod> tool, const Rod& other) noexcept {
  Deepest found;
  for (std::size_t i = 0; i < std::min(tool.size(), kMost); ++i) {
    RodDistance apart = distance(tool[i], other);
    Eigen::Vector3d& side = sides_[i];
    if (side.dot(apart.normal) < 0.0) {  // the axes have crossed
      apart = {-apart.between_axes, -apart.normal};
    }
    const double reach = tool[i].radius + other.radius;
    const double depth = reach - apart.between_axes;
    const bool meet = depth > 0.0 && depth < 2.0 * reach;
    side = meet ? apart.normal : Eigen::Vector3d::Zero();
    const double pushing = meet ? pushing_depth(depth, reach) : 0.0;
    if (pushing > found.depth) {
      found = {pushing, apart.normal};
    }
  }
  return found;
}

Eigen::Vector3d ToolContact::force(std::span<const Rod> tool, const Rod& other,
                                   const Eigen::Vector3d& closing, double held) noexcept {
  const Deepest found = deepest(tool, other);
  waits_until_free_ = waits_until_free_ && found.depth > 0.0;
  if (waits_until_free_ || found.depth <= 0.0) {
    return Eigen::Vector3d::Zero();
  }
  const double rate = closing.dot(found.normal);  // of the depth [m/s]
  const double depth = std::max(0.0, found.depth + 0.5 * held * rate);
  const double force = p_.stiffness * depth * std::max(0.0, 1.0 + p_.damping * rate);
  return std::min(force, p_.force_limit) * found.normal;
}

}  // namespace haptrial::bone
