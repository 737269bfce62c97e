#include "core/control/tutoring/wave_port.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace haptrial::control {

WavePort::WavePort(const WaveParameters& parameters, const TutoringGains& gains,
                   const Eigen::Vector3d& start)
    : p_(parameters), gains_(gains) {
  if (!(parameters.impedance > 0.0) || !std::isfinite(parameters.impedance)) {
    throw std::invalid_argument("WavePort: the impedance must be above 0");
  }
  if (!(gains.stiffness >= 0.0) || !(gains.damping >= 0.0)) {
    throw std::invalid_argument("WavePort: stiffness and damping must be at least 0");
  }
  reference_.position = start;
}

// The tool feels f = K (x_r - x) + D (v_r - v); the reference feels -f, which is what it gives to
// the line: f_line = b v_r - sqrt(2 b) w. Solved for v_r, so that no tick of delay comes in.
Eigen::Vector3d WavePort::step(const Eigen::Vector3d& incoming, const PointState& own, double dt,
                               double share) noexcept {
  const double b = p_.impedance;
  const double stiffness = share * gains_.stiffness;
  const double damping = share * gains_.damping;
  const double root = std::sqrt(2.0 * b);
  const Eigen::Vector3d stretch = reference_.position - own.position;
  const double whole = b + damping + stiffness * dt;  // x_r of the tick's end
  reference_.velocity = (root * incoming - stiffness * stretch + damping * own.velocity) / whole;
  reference_.position += reference_.velocity * dt;
  const Eigen::Vector3d into = b * reference_.velocity - root * incoming;
  outgoing_ = root * reference_.velocity - incoming;
  into_line_ += into.dot(reference_.velocity) * dt;
  budget_ += damping * (reference_.velocity - own.velocity).squaredNorm() * dt;
  return -into;
}

void WavePort::let_go(const Eigen::Vector3d& own) noexcept {
  reference_ = {own, Eigen::Vector3d::Zero()};
  outgoing_.setZero();
  budget_ = 0.0;
}

void WavePort::correct(const Eigen::Vector3d& partner, const Eigen::Vector3d& own) noexcept {
  const Eigen::Vector3d shift = p_.correction * (partner - reference_.position);
  const Eigen::Vector3d stretch = reference_.position - own;
  const double cost =
      gains_.stiffness * (stretch.dot(shift) + 0.5 * shift.squaredNorm());  // in the spring [J]
  if (!std::isfinite(cost)) {
    return;
  }
  const double part = cost > budget_ ? std::max(0.0, budget_ / cost) : 1.0;
  reference_.position += part * shift;
  budget_ -= std::max(0.0, part * cost);
}

}  // namespace haptrial::control
