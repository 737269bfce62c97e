#include "core/scene/detent.h"

#include <algorithm>
#include <cmath>

#include "core/base/require.h"

namespace haptrial::scene {
namespace {

using Eigen::Vector3d;

Vector3d unit_of(const Vector3d& direction, const char* sentence) {
  require(direction.allFinite() && direction.norm() > 0.0, sentence);
  return direction.normalized();
}

}  // namespace

Detent::Detent(const DetentParameters& p, const Setting& setting)
    : parameters_(p),
      direction_(unit_of(p.direction, "Detent: direction must be finite and not zero")),
      wave_(2.0 * std::numbers::pi / p.spacing),
      way_(setting.rate),
      period_(1.0 / setting.rate) {
  require(p.at.allFinite(), "Detent: at must be finite");
  require(std::isfinite(p.spacing) && p.spacing > 0.0,
          "Detent: spacing must be finite and above 0");
  require(p.peak >= 0.0 && p.peak <= setting.limit, "Detent: peak must be from 0 to the limit");
  require(p.count >= 0, "Detent: count must be at least 0");
}

/// s, or the nearest s where it ends and the force is 0.
double Detent::within(const Vector3d& p) const noexcept {
  const double s = direction_.dot(p - parameters_.at);
  return parameters_.count == 0 ? s
                                : std::clamp(s, -0.5 * parameters_.spacing,
                                             (parameters_.count - 0.5) * parameters_.spacing);
}

Vector3d Detent::force(const Felt& felt, FieldState& state) noexcept {
  const double s = within(felt.hand.position);
  state.depth = std::abs(std::remainder(s, parameters_.spacing));
  const double size = -felt.shares.stiffness * parameters_.peak * std::sin(wave_ * s);
  const double ahead = std::abs(direction_.dot(way_.next(felt.hand.velocity)));
  if (passing_.look(ahead / parameters_.spacing, period_)) {
    state.stimulus = size * direction_;
  }
  return size * direction_;
}

void Detent::adopt(const Detent& before) noexcept {
  way_.adopt(before.way_);
  passing_ = before.passing_;
}

double Detent::energy(const Vector3d& p) const noexcept {
  return parameters_.peak / wave_ * (1.0 - std::cos(wave_ * within(p)));
}

Click::Click(const ClickParameters& p, const Setting& setting)
    : parameters_(p),
      direction_(unit_of(p.direction, "Click: direction must be finite and not zero")) {
  require(p.at.allFinite(), "Click: at must be finite");
  require(p.peak >= 0.0 && p.peak <= setting.limit, "Click: peak must be from 0 to the limit");
  require(std::isfinite(p.travel) && p.travel > 0.0, "Click: travel must be finite and above 0");
  require(p.drop >= 0.0 && p.drop <= p.peak, "Click: drop must be from 0 to the peak");
  require(std::isfinite(p.drop_travel) && p.drop_travel > 0.0,
          "Click: drop_travel must be finite and above 0");
}

Vector3d Click::force(const Felt& felt, FieldState& state) noexcept {
  const ClickParameters& p = parameters_;
  const double d = std::max(direction_.dot(felt.hand.position - p.at), 0.0);
  const double u = std::clamp((d - p.travel) / p.drop_travel, 0.0, 1.0);
  state.depth = d;
  state.contact = d > 0.0;
  state.done = u >= 1.0;
  const double size =
      p.peak * std::min(d / p.travel, 1.0) - 0.5 * p.drop * (1.0 - std::cos(std::numbers::pi * u));
  return -felt.shares.stiffness * size * direction_;
}

double Click::energy(const Vector3d& place) const noexcept {
  const ClickParameters& p = parameters_;
  const double d = std::max(direction_.dot(place - p.at), 0.0);
  const double rise = std::min(d, p.travel);
  const double fall = std::clamp(d - p.travel, 0.0, p.drop_travel);
  const double stay = std::max(d - p.travel - p.drop_travel, 0.0);
  const double angle = std::numbers::pi * fall / p.drop_travel;
  return 0.5 * p.peak * rise * rise / p.travel + p.peak * fall -
         0.5 * p.drop * (fall - p.drop_travel / std::numbers::pi * std::sin(angle)) +
         (p.peak - p.drop) * stay;
}

}  // namespace haptrial::scene
