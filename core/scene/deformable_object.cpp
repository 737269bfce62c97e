#include "core/scene/deformable_object.h"

#include <limits>
#include <utility>

#include "core/deformable/touch/prepared.h"

namespace haptrial::scene {

using Eigen::Vector3d;

/// The spring between hand and ball and the body behind it, along each other; friction bends a
/// bristle that is no stiffer. Of a body that moves or is not prepared the spring alone is known.
/// A moving body keeps an account of its energy, in which the hand has a damping.
StiffnessBound DeformableObjectParameters::bound() const {
  const double behind = body ? deformable::stiffest_touch(*body, tool.radius)
                             : std::numeric_limits<double>::infinity();
  const double both = 1.0 / (1.0 / tool.stiffness + 1.0 / behind);
  return {true, tool.friction.static_friction > 0.0 ? 2.0 * both : both,
          moves() ? deformable::EnergyAccount::kDamping : 0.0};
}

DeformableObject::DeformableObject(const DeformableObjectParameters& parameters,
                                   const Setting& setting)
    : parameters_(parameters), period_(1.0 / setting.rate) {
  if (parameters.moving && parameters.gives) {
    touch_ = std::make_unique<deformable::TwoRateTouch>(parameters.moving, parameters.gives,
                                                        parameters.tool, period_, parameters.rates,
                                                        parameters.shape);
  } else if (parameters.moving) {
    touch_ = std::make_unique<deformable::MovingTouch>(parameters.moving, parameters.tool, period_,
                                                       parameters.shape);
  } else if (parameters.body) {
    touch_ = std::make_unique<deformable::BallTouch>(parameters.body, parameters.tool);
  } else {
    deformable::check(parameters.tool);
  }
}

Vector3d DeformableObject::to_body(const Vector3d& p) const noexcept {
  return parameters_.pose.orientation.conjugate() * (p - parameters_.pose.position);
}

void DeformableObject::start(const PointState& hand) noexcept {
  hand_ = hand.position;
  if (touch_) {
    touch_->start(to_body(hand.position));
  }
}

/// A body that moves goes on moving, and the contact with one that rests goes on, also if its
/// tissue changes; any other begins at rest under the hand.
void DeformableObject::adopt(DeformableObject& before) noexcept {
  hand_ = before.hand_;
  if (is_same_of_own_rate(before)) {
    std::swap(touch_, before.touch_);
    return;
  }
  if (touch_ && before.touch_) {
    touch_->adopt(*before.touch_, to_body(hand_));
  } else if (touch_) {
    touch_->start(to_body(hand_));
  }
}

/// A thread of its own steps such a body, so that its state can't be taken over between two ticks.
bool DeformableObject::is_same_of_own_rate(const DeformableObject& other) const noexcept {
  const deformable::TouchOptions& tool = parameters_.tool;
  const deformable::TouchOptions& its = other.parameters_.tool;
  return parameters_.gives && parameters_.gives == other.parameters_.gives &&
         parameters_.moving == other.parameters_.moving &&
         parameters_.pose.position == other.parameters_.pose.position &&
         parameters_.pose.orientation.coeffs() == other.parameters_.pose.orientation.coeffs() &&
         tool.radius == its.radius && tool.stiffness == its.stiffness &&
         tool.friction.static_friction == its.friction.static_friction &&
         tool.friction.dynamic_friction == its.friction.dynamic_friction;
}

Vector3d DeformableObject::force(const Felt& felt, FieldState& state) noexcept {
  hand_ = felt.hand.position;
  state.sliding = false;
  state.depth = 0.0;
  if (!touch_) {
    return Vector3d::Zero();
  }
  const contact::Contact& contact = touch_->tick(to_body(hand_), period_);
  const auto& q = parameters_.pose.orientation;
  state.proxy = q * contact.proxy + parameters_.pose.position;
  if (contact.state == contact::ContactState::kFree) {
    return Vector3d::Zero();
  }
  state.depth = contact.depth;
  state.sliding = contact.state == contact::ContactState::kSlip;
  state.normal = q * contact.normal;
  return felt.shares.stiffness * (q * contact.force);
}

}  // namespace haptrial::scene
