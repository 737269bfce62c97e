#include "core/control/pd_controller.h"

#include <cmath>
#include <stdexcept>

#include "core/base/definition/schema.h"
#include "core/base/longer.h"

namespace haptrial::control {

const Schema<PdGains>& pd_gains_schema() {
  static const auto schema = Schema<PdGains>()
                                 .number("stiffness", &PdGains::stiffness, {0.0, 1e5}, "N/m",
                                         "Stiffness of the spring that guides the hand")
                                 .required()
                                 .number("damping", &PdGains::damping, {0.0, 1e4}, "N·s/m",
                                         "Damping beside the spring that guides the hand")
                                 .required();
  return schema;
}

PdController::PdController(const PdGains& gains) : gains_(gains) {
  if (!(gains.stiffness >= 0.0) || !std::isfinite(gains.stiffness)) {
    throw std::invalid_argument("PdController: stiffness must be finite and at least 0");
  }
  if (!(gains.damping >= 0.0) || !std::isfinite(gains.damping)) {
    throw std::invalid_argument("PdController: damping must be finite and at least 0");
  }
}

Eigen::Vector3d PdController::force(const PointState& target, const PointState& tip,
                                    const GainShares& shares) const noexcept {
  const Eigen::Vector3d f = shares.stiffness * gains_.stiffness * (target.position - tip.position) +
                            shares.damping * gains_.damping * (target.velocity - tip.velocity);
  return f.allFinite() ? f : Eigen::Vector3d::Zero();
}

double PdController::stored(double stretch, double limit, double share) const noexcept {
  const double stiffness = share * gains_.stiffness;
  const double force = stiffness * std::abs(stretch);
  return force <= limit ? 0.5 * force * std::abs(stretch)
                        : limit * (std::abs(stretch) - 0.5 * limit / stiffness);
}

Eigen::Vector3d saturate(const Eigen::Vector3d& force, double limit) noexcept {
  return longer(force, limit) ? Eigen::Vector3d(force * (limit / force.norm())) : force;
}

}  // namespace haptrial::control
