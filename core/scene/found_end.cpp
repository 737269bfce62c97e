#include "core/scene/found_end.h"

#include <utility>

namespace haptrial::scene {

Eigen::Vector3d FoundEnd::bounded(const Eigen::Vector3d& force, const PointState& hand,
                                  double period) noexcept {
  constexpr double kFastest = 200.0;  // [N/s]
  constexpr double kDepth = 0.001;    // over which a damper comes to act as a whole [m]
  const double way = (hand.position - hand_.position).norm();
  const double damped =
      (hand.velocity - hand_.velocity).norm() + hand.velocity.norm() * way / kDepth;
  const double explained = gains_.stiffness * way + gains_.damping * damped;
  const Eigen::Vector3d change = force - force_;
  const double most = explained + kFastest * period;
  const bool jumps = std::exchange(follows_, true) && change.squaredNorm() > most * most;
  force_ = jumps ? Eigen::Vector3d(force_ + control::saturate(change, most)) : force;
  hand_ = hand;
  return force_;
}

}  // namespace haptrial::scene
