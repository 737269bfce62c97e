#include "core/scene/surface.h"

#include <algorithm>

#include "core/contact/normal_spring.h"

namespace haptrial::scene {
namespace {

using Eigen::Vector3d;

// Over this the force fades towards the middle of a shape, and turns from one face to another [m].
constexpr double kCore = 2e-3;

}  // namespace

/// Nothing is proven of a shape whose distances another program computes.
StiffnessBound SurfaceParameters::bound() const {
  return {!std::holds_alternative<RegisteredShape>(shape), gains.stiffness, gains.damping};
}

FieldTraits SurfaceParameters::traits() const {
  const bool closes_in = std::holds_alternative<RegisteredShape>(shape) ||
                         (felt_from_inside && !std::holds_alternative<HalfSpace>(shape));
  return {.surface = true, .closes_in = closes_in, .yields = true};
}

Surface::Surface(const SurfaceParameters& parameters, const Setting& setting)
    : shape_(parameters.shape),
      inside_(parameters.felt_from_inside),
      gains_(control::PdController(parameters.gains).gains()),
      limit_(setting.limit),
      deepest_(shape_.deepest()),
      core_(std::min(kCore, deepest_)) {}

/// Towards the middle of a shape the depth grows ever less, so that the force, its gradient times
/// the spring, fades: a hand that is pushed through would be struck where it turns round.
Surface::Side Surface::free_side(const Vector3d& p) const noexcept {
  if (inside_) {
    const SurfaceDistance found = shape_.distance(p);
    return {found.distance, -found.normal, 1.0};
  }
  const SurfaceDistance found = shape_.distance(p, kCore);
  const double whole = deepest_ - core_;
  const double beyond = std::max(-found.distance - whole, 0.0);
  const double share = 1.0 - beyond / core_;
  return {beyond > 0.0 ? whole + 0.5 * (1.0 + share) * beyond : -found.distance, found.normal,
          share * found.slope};
}

/// Force without the relief, which is felt beyond it.
Vector3d Surface::flat_force(const Side& here, const Felt& felt) const noexcept {
  const double damping = felt.shares.damping * contact::damper_share(here.depth);
  const double wanted = felt.shares.stiffness * gains_.stiffness * here.depth -
                        damping * gains_.damping * here.share * here.normal.dot(felt.hand.velocity);
  return here.depth > 0.0 ? Vector3d(std::clamp(wanted, 0.0, limit_) * here.share * here.normal)
                          : Vector3d(Vector3d::Zero());
}

Vector3d Surface::force(const Felt& felt, FieldState& state) noexcept {
  const Side here = free_side(felt.hand.position);
  const double depth = relief_.height + here.depth;                // e
  const Vector3d lean = here.share * here.normal - relief_.slope;  // g
  state.normal = here.normal;
  state.contact = depth > 0.0;
  state.depth = std::max(0.0, depth);
  touch_ = {here.normal, 0.0, -here.normal.dot(felt.hand.velocity)};
  if (relief_.passes) {
    state.stimulus = -flat_force(here, felt);
  }
  if (!state.contact) {
    return Vector3d::Zero();
  }
  const double most = limit_ / (1.0 + relief_.steepest);
  const double damping = felt.shares.damping * contact::damper_share(depth);
  const double wanted = felt.shares.stiffness * gains_.stiffness * depth -
                        damping * gains_.damping * lean.dot(felt.hand.velocity);
  const double pushed = std::clamp(wanted, 0.0, most);
  state.limited = wanted > most;
  const Vector3d force = pushed * lean;
  if (relief_.passes) {
    state.stimulus += force;
  }
  touch_.pressing = std::max(force.dot(here.normal), 0.0);
  return force;
}

double Surface::energy(const Vector3d& p) const noexcept {
  return stored(std::max(relief_.height + free_side(p).depth, 0.0), 1.0);
}

double Surface::stored(double depth, double share) const noexcept {
  return control::PdController(gains_).stored(depth, limit_ / (1.0 + relief_.steepest), share);
}

}  // namespace haptrial::scene
