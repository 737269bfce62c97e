#include "core/scene/mover.h"

#include <cmath>

#include "core/base/require.h"

namespace haptrial::scene {
namespace {

/// Peak speed of a minimum-jerk move over its mean.
constexpr double kPeakOverMean = 1.875;

}  // namespace

Mover::Mover(const MoverParameters& p, const Setting&)
    : to_(p.to), duration_(p.duration), controller_(p.gains) {
  require(p.to.allFinite(), "Mover: to must be finite");
  require(std::isfinite(p.duration) && p.duration > 0.0,
          "Mover: duration must be finite and above 0");
}

void Mover::start(const PointState& hand) noexcept {
  const double way = (to_ - hand.position).norm();
  // A hand that is there already gets a move of no duration.
  move_ = control::MinimumJerkMove(hand.position, to_,
                                   way > 0.0 ? kPeakOverMean * way / duration_ : 1.0);
}

Eigen::Vector3d Mover::force(const Felt& felt, FieldState& state) noexcept {
  state.depth = (to_ - felt.hand.position).norm();
  state.done = felt.time >= duration_;
  return controller_.force(move_.at(felt.time), felt.hand, felt.shares);
}

}  // namespace haptrial::scene
