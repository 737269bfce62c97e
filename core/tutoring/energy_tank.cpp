#include "core/tutoring/energy_tank.h"

#include <algorithm>
#include <cmath>

namespace haptrial::tutoring {

void EnergyTank::account(const Eigen::Vector3d& moved, double received) noexcept {
  if (received > received_) {  // a total that comes late is lower, and old
    level_ += received - received_;
    received_ = received;
  }
  const double got = force_.dot(moved);
  given_ += got;
  level_ -= got;
  const double send = std::max(0.0, p_.share * level_);
  level_ -= send;
  sent_ += send;
}

double EnergyTank::damping() const noexcept {
  return std::clamp(p_.refill * (p_.wanted - level_), 0.0, p_.most_damping);
}

/// The greatest share s of a force with s a + s² b <= most. @param b  >= 0
static double share_within(double a, double b, double most) noexcept {
  if (a + b <= most) {
    return 1.0;
  }
  return b > 0.0 ? (std::sqrt(a * a + 4.0 * b * most) - a) / (2.0 * b) : most / a;
}

Eigen::Vector3d EnergyTank::limit(const Eigen::Vector3d& wanted, const Eigen::Vector3d& moved,
                                  const Eigen::Vector3d& velocity, double received, double dt,
                                  double share) noexcept {
  if (!moved.allFinite() || !velocity.allFinite() || !wanted.allFinite()) {
    force_.setZero();
    cut_ = 0.0;
    return force_;
  }
  account(moved, received);
  Eigen::Vector3d force = wanted - share * damping() * velocity;
  force *= share_within(force.dot(velocity) * dt,
                        0.5 * force.squaredNorm() * dt * dt / p_.least_mass, std::max(0.0, level_));
  cut_ = (force - wanted).norm();
  force_ = force;
  return force;
}

void EnergyTank::let_go(const Eigen::Vector3d& moved, double received) noexcept {
  if (moved.allFinite()) {
    account(moved, received);
  }
  force_.setZero();
  cut_ = 0.0;
}

}  // namespace haptrial::tutoring
