#include "core/scene/rigid_object.h"

#include <algorithm>
#include <cmath>

#include "core/base/require.h"
#include "core/contact/normal_spring.h"
#include "core/contact/renderer_kinds.h"

namespace haptrial::scene {

using contact::ContactState;
using Eigen::Vector3d;

namespace {

/// Forces are reckoned in W, lengths by the renderer in the body's frame.
contact::RendererOptions options_of(const RigidObjectParameters& p) {
  contact::RendererOptions options;
  options.stiffness = p.gains.stiffness * p.scale;
  options.damping = p.gains.damping * p.scale;
  options.unit = p.scale;
  options.radius = p.tool_radius / p.scale;
  options.friction = p.friction;
  options.crease_angle = p.crease_angle;
  options.resolution = p.resolution;
  return options;
}

}  // namespace

/// The proxy moves only to come nearer to the tool: the spring between them gives back at most what
/// it was given, and turns against the hand by k at most, also where friction holds the proxy.
/// Shading turns the force away from that way, and renderers without a proxy jump: of them nothing
/// is proven.
StiffnessBound RigidObjectParameters::bound() const {
  const bool passive = contact::kind_of(renderer).passive && crease_angle < 0.0;
  return {passive, gains.stiffness, gains.damping};
}

RigidObject::RigidObject(const RigidObjectParameters& parameters, const Setting& setting)
    : parameters_(parameters),
      period_(1.0 / setting.rate),
      limit_(setting.limit),
      end_(parameters.gains) {
  require(std::isfinite(parameters.scale) && parameters.scale > 0.0,
          "RigidObject: scale must be finite and above 0");
  if (parameters.body) {
    renderer_ = contact::make_renderer(parameters.renderer, parameters.body->mesh,
                                       parameters.body->surface, options_of(parameters));
  }
}

Vector3d RigidObject::to_body(const Vector3d& p) const noexcept {
  return parameters_.pose.orientation.conjugate() * (p - parameters_.pose.position) /
         parameters_.scale;
}

void RigidObject::begin_at(const Vector3d& p) noexcept {
  const double radius = parameters_.tool_radius / parameters_.scale;
  renderer_->start(contact::free_place(*parameters_.body, to_body(p), radius));
}

void RigidObject::start(const PointState& hand) noexcept {
  touch_ = {};
  end_.start();
  proxy_ = hand.position;
  if (renderer_) {
    begin_at(hand.position);
  }
}

/// The proxy goes on from where it was, if the body lets it.
void RigidObject::adopt(const RigidObject& before) noexcept {
  touch_ = before.touch_;
  end_.start();
  proxy_ = before.proxy_;
  if (renderer_) {
    begin_at(proxy_);
  }
}

Vector3d RigidObject::push(const contact::Contact& contact, const Felt& felt,
                           FieldState& state) noexcept {
  const auto& q = parameters_.pose.orientation;
  const Vector3d normal = q * contact.normal;
  const Vector3d whole = felt.shares.stiffness * (q * contact.force);
  if (!(relief_.highest > 0.0)) {
    return whole;
  }
  const Vector3d dragged = whole - whole.dot(normal) * normal;
  const double depth = parameters_.scale * contact.depth + relief_.height - relief_.highest;  // e
  state.depth = std::max(depth, 0.0);
  state.contact = depth > 0.0;
  if (relief_.passes) {
    state.stimulus = -whole;
  }
  if (!state.contact) {
    return Vector3d::Zero();
  }
  const Vector3d lean = normal - relief_.slope;  // g
  const double most = limit_ / (1.0 + relief_.steepest);
  const double damping = felt.shares.damping * contact::damper_share(depth);
  const double wanted = felt.shares.stiffness * parameters_.gains.stiffness * depth -
                        damping * parameters_.gains.damping * lean.dot(felt.hand.velocity);
  state.limited = wanted > most;
  const Vector3d force = std::clamp(wanted, 0.0, most) * lean + dragged;
  if (relief_.passes) {
    state.stimulus += force;
  }
  return force;
}

double RigidObject::stored(double depth, double share) const noexcept {
  return control::PdController(parameters_.gains)
      .stored(depth, limit_ / (1.0 + relief_.steepest), share);
}

Vector3d RigidObject::force(const Felt& felt, FieldState& state) noexcept {
  state.contact = state.sliding = false;
  state.depth = 0.0;
  touch_.pressing = 0.0;
  if (!renderer_) {
    return Vector3d::Zero();
  }
  // The share of stiffness is taken from the whole force, so the damper's own is over it.
  renderer_->set_damping_share(felt.shares.damping / felt.shares.stiffness);
  const contact::Contact& contact = renderer_->tick(to_body(felt.hand.position), period_);
  proxy_ = parameters_.pose.orientation * (parameters_.scale * contact.proxy) +
           parameters_.pose.position;
  state.proxy = proxy_;
  if (!(contact.depth > 0.0) || !contact.force.allFinite()) {
    return follow(Vector3d::Zero(), felt, state);
  }
  state.contact = true;
  state.depth = parameters_.scale * contact.depth;
  state.sliding = contact.state == ContactState::kSlip;
  state.normal = parameters_.pose.orientation * contact.normal;
  const Vector3d force = follow(push(contact, felt, state), felt, state);
  touch_ = {state.normal, std::max(0.0, force.dot(state.normal)),
            -state.normal.dot(felt.hand.velocity)};
  return force;
}

/// Ridges, the moment at which friction gives way, and what another renderer than a proxy does are
/// steps that are meant.
Vector3d RigidObject::follow(const Vector3d& force, const Felt& felt, FieldState& state) noexcept {
  const bool gives_way = state.sliding && !slid_;
  slid_ = state.sliding;
  if (relief_.highest > 0.0 || gives_way || !contact::kind_of(parameters_.renderer).passive) {
    end_.start();
  }
  state.limited = state.limited || force.norm() > limit_;
  const double share = felt.shares.stiffness;
  return share * end_.bounded(control::saturate(force, limit_) / share, felt.hand, period_);
}

}  // namespace haptrial::scene
