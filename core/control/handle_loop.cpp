#include "core/control/handle_loop.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <stdexcept>

#include "core/base/matrix_functions.h"

namespace haptrial::control {
namespace {

void check(const HandleLoop& loop, const HeldBy& hand) {
  if (!(loop.handle_mass > 0.0 && loop.rate > 0.0) || loop.velocity_window < 2 ||
      loop.force_delay < 1 || !(hand.mass >= 0.0 && hand.damping >= 0.0 && hand.stiffness >= 0.0)) {
    throw std::invalid_argument(
        "HandleLoop: handle_mass and rate must be above 0, velocity_window at least 2, "
        "force_delay at least 1, and nothing of the hand below 0");
  }
}

/// Position and velocity after a tick, of position, velocity and the force held over it.
Eigen::Matrix<double, 2, 3> exact_step(const HandleLoop& loop, const HeldBy& hand) {
  const double mass = loop.handle_mass + hand.mass;
  Eigen::Matrix3d flow = Eigen::Matrix3d::Zero();
  flow.row(0) << 0.0, 1.0, 0.0;
  flow.row(1) << -hand.stiffness / mass, -hand.damping / mass, 1.0 / mass;
  return matrix_exponential(flow / loop.rate).topRows(2);
}

/// One tick of the state: position, velocity, forces on their way (oldest first), readings (newest
/// first).
Eigen::MatrixXd tick_of(const PdGains& gains, const HandleLoop& loop, const HeldBy& hand) {
  check(loop, hand);
  const int n = loop.velocity_window;
  const int d = loop.force_delay;
  const int reading = 2 + d;
  Eigen::RowVectorXd force = Eigen::RowVectorXd::Zero(reading + n);
  double squares = 0.0;
  for (int i = 0; i < n; ++i) {
    const double centred = 0.5 * (n - 1) - i;
    squares += centred * centred;
  }
  for (int i = 0; i < n; ++i) {
    force[reading + i] = -gains.damping * (0.5 * (n - 1) - i) / squares * loop.rate;
  }
  force[reading] -= gains.stiffness;

  Eigen::MatrixXd tick = Eigen::MatrixXd::Zero(reading + n, reading + n);
  tick.topLeftCorner(2, 3) = exact_step(loop, hand);
  for (int i = 0; i + 1 < d; ++i) {
    tick(2 + i, 3 + i) = 1.0;
  }
  tick.row(1 + d) = force;
  tick.row(reading) = tick.row(0);
  for (int i = 1; i < n; ++i) {
    tick(reading + i, reading + i - 1) = 1.0;
  }
  return tick;
}

/// @param holds  whether a hand of this mass is heavy enough
template <typename Holds>
double lightest(double heaviest, Holds holds) {
  constexpr double kResolution = 1e-3;  // [kg]
  if (holds(0.0)) {
    return 0.0;
  }
  if (!holds(heaviest)) {
    return heaviest + 1.0;
  }
  double low = 0.0;
  double high = heaviest;
  while (high - low > kResolution) {
    const double middle = 0.5 * (low + high);
    (holds(middle) ? high : low) = middle;
  }
  return high;
}

}  // namespace

double velocity_of_a_step(double quantum, int window, double rate) noexcept {
  const double n = window;
  return 1.5 * quantum * rate * n / (n * n - 1.0);
}

double spectral_radius(const PdGains& gains, const HandleLoop& loop, const HeldBy& hand) {
  return haptrial::spectral_radius(tick_of(gains, loop, hand));
}

double dominant_frequency(const PdGains& gains, const HandleLoop& loop, const HeldBy& hand) {
  const std::complex<double> eigenvalue = dominant_eigenvalue(tick_of(gains, loop, hand));
  return std::abs(std::arg(eigenvalue)) / (2.0 * std::numbers::pi) * loop.rate;
}

double lightest_stable_hand(const PdGains& gains, const HandleLoop& loop, double heaviest) {
  // A free mass that is pushed by nothing stays where it is: an eigenvalue of 1.
  constexpr double kStable = 1.0 + 1e-9;
  return lightest(heaviest, [&](double mass) {
    return spectral_radius(gains, loop, {mass, 0.0, 0.0}) <= kStable;
  });
}

HeldBy held_by_hand(double mass) noexcept { return {mass, 15.0 * mass / 0.8, 250.0 * mass / 0.8}; }

bool is_calm(const PdGains& gains, const HandleLoop& loop, const HeldBy& hand) {
  constexpr double kTime = 0.2;  // [s]
  return std::pow(spectral_radius(gains, loop, hand), kTime * loop.rate) < 2.0;
}

double lightest_calm_hand(const PdGains& gains, const HandleLoop& loop, double heaviest) {
  return lightest(heaviest, [&](double mass) { return is_calm(gains, loop, held_by_hand(mass)); });
}

double damping_of_bare_handle(double damping, const HandleLoop& loop) noexcept {
  const double age = (0.5 * loop.velocity_window + 3.0) / loop.rate;
  return std::min(damping, 0.5 * loop.handle_mass / age);
}

}  // namespace haptrial::control
