#include "core/tutoring/tutoring_law.h"

#include <algorithm>

namespace haptrial::tutoring {

static Eigen::Vector3d towards(const TutoringGains& gains, const PointState& partner,
                               const PointState& own, const control::GainShares& shares) noexcept {
  return shares.stiffness * gains.stiffness * (partner.position - own.position) +
         shares.damping * gains.damping * (partner.velocity - own.velocity);
}

Eigen::Vector3d coupling_force(const TutoringGains& gains, const PointState& partner,
                               const PointState& own, const control::GainShares& shares) noexcept {
  const Eigen::Vector3d f = towards(gains, partner, own, shares);
  return f.allFinite() ? f : Eigen::Vector3d::Zero();
}

Eigen::Vector3d tutoring_force(const TutoringGains& gains, const Lead& lead, const Partner& partner,
                               const PointState& own, const Eigen::Vector3d& own_force,
                               const control::GainShares& shares) noexcept {
  const double a = std::clamp(lead.partner, 0.0, 1.0);
  const double coupled = std::max(a, std::clamp(lead.felt_back, 0.0, 1.0));
  const Eigen::Vector3d f = (1.0 - a) * own_force + a * gains.force_share * partner.force +
                            coupled * towards(gains, partner.tool, own, shares);
  return f.allFinite() ? f : Eigen::Vector3d::Zero();
}

void Handover::ask(double share) noexcept { asked_ = share > 0.0 ? std::min(share, 1.0) : 0.0; }

double Handover::step(double dt) noexcept {
  const double most = rate_ * dt;
  share_ += std::clamp(asked_ - share_, -most, most);
  return share_;
}

double stiffest_over_delay(double damping, double period, double delay) noexcept {
  return damping / (0.5 * period + delay);
}

}  // namespace haptrial::tutoring
