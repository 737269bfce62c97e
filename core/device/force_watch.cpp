#include "core/device/force_watch.h"

#include <algorithm>
#include <cmath>

namespace haptrial::device {
namespace {

constexpr int kTurns = 4;
constexpr double kBetweenTurns = 0.080;  // [s]
constexpr double kLasting = 0.073;       // [s]
constexpr double kSwing = 0.5;           // of the limit
constexpr double kNear = 0.7;            // of the limit
constexpr double kAtTheLimit = 0.98;     // of it

}  // namespace

Fault ForceWatch::look(const Eigen::Vector3d& force, double dt) noexcept {
  time_ += dt;
  saturated_for_ = force.norm() >= kAtTheLimit * limit_ ? saturated_for_ + dt : 0.0;
  bool oscillates = false;
  for (int i = 0; i < 3; ++i) {
    oscillates = turns_too_often(axes_[static_cast<std::size_t>(i)], force[i]) || oscillates;
  }
  if (oscillates) {
    return Fault::kOscillation;
  }
  return saturated_for_ > longest_ ? Fault::kSaturation : Fault::kNone;
}

bool ForceWatch::turns_too_often(Axis& axis, double force) const noexcept {
  const double swing = force - axis.extreme;
  const bool near_limit = std::max(std::abs(force), std::abs(axis.extreme)) > kNear * limit_;
  const bool turned =
      near_limit && std::abs(swing) > kSwing * limit_ && swing * axis.direction <= 0.0;
  const bool goes_on = swing * axis.direction > 0.0;
  if (goes_on || turned) {
    axis.extreme = force;
  }
  if (!turned) {
    return false;
  }
  axis.direction = swing > 0.0 ? 1 : -1;
  const bool follows = axis.turns > 0 && time_ - axis.latest_turn <= kBetweenTurns;
  axis.turns = follows ? axis.turns + 1 : 1;
  axis.first_turn = follows ? axis.first_turn : time_;
  axis.latest_turn = time_;
  return axis.turns >= kTurns && time_ - axis.first_turn >= kLasting;
}

}  // namespace haptrial::device
