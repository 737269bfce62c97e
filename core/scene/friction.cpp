#include "core/scene/friction.h"

#include <cmath>

#include "core/base/require.h"

namespace haptrial::scene {

namespace {

constexpr double kHolds = 0.9;  // of the dynamic deflection: below it the hand has turned back
constexpr double kRest = 0.05;  // without a way forward it sticks again [s]

}  // namespace

using Eigen::Vector3d;

Friction::Friction(const FrictionParameters& p, const Setting&) : parameters_(p) {
  require(std::isfinite(p.dynamic_level) && p.dynamic_level >= 0.0,
          "Friction: dynamic_level must be finite and at least 0");
  require(std::isfinite(p.static_level) && p.static_level >= p.dynamic_level,
          "Friction: static_level must be finite and at least dynamic_level");
  require(std::isfinite(p.stiffness) && p.stiffness > 0.0,
          "Friction: stiffness must be finite and above 0");
  require(p.model == FrictionParameters::Model::kBristle || p.static_level == p.dynamic_level,
          "Friction: static_level and dynamic_level must be the same with Dahl's model");
}

void Friction::start(const PointState& hand) noexcept {
  z_.setZero();
  before_ = hand.position;
  sliding_ = false;
  slid_at_ = 0.0;
}

Vector3d Friction::force(const Felt& felt, FieldState& state) noexcept {
  Vector3d way = felt.hand.position - before_;
  before_ = felt.hand.position;
  double pressing = 1.0;
  if (felt.surface != nullptr) {
    const Vector3d& n = felt.surface->normal;
    pressing = felt.surface->pressing;
    way -= n.dot(way) * n;
    z_ -= n.dot(z_) * n;
  }
  z_ += way;
  const double stiffness = felt.shares.stiffness * parameters_.stiffness;
  const double longest = parameters_.dynamic_level * pressing / stiffness;
  const bool dahl = parameters_.model == FrictionParameters::Model::kDahl;
  if (dahl && longest > 0.0) {
    z_ /= 1.0 + way.norm() / longest;
  }
  const double length = z_.norm();
  if (z_.dot(way) > 0.0) {
    slid_at_ = felt.time;
  }
  const bool shortened = z_.dot(way) < 0.0 && length < kHolds * longest;
  if (shortened || felt.time - slid_at_ > kRest) {
    sliding_ = false;
  }
  const double level = sliding_ ? parameters_.dynamic_level : parameters_.static_level;
  if (length > level * pressing / stiffness) {
    sliding_ = true;
    z_ *= longest / length;
  }
  state.sliding = sliding_;
  state.depth = z_.norm();
  return -stiffness * z_;
}

void Friction::adopt(const Friction& before) noexcept {
  z_ = before.z_;
  before_ = before.before_;
  sliding_ = before.sliding_;
  slid_at_ = before.slid_at_;
}

}  // namespace haptrial::scene
