#include "core/scene/inertia.h"

#include <cmath>
#include <numbers>
#include <vector>

#include "core/base/matrix_functions.h"
#include "core/base/require.h"

namespace haptrial::scene {
namespace {

using Eigen::Vector3d;

/// Weights of the least-squares slope over n readings, as weights on its n - 1 differences,
/// newest first; their sum is 1.
std::vector<double> weights_of_slope(int n) {
  double squares = 0.0;
  for (int i = 0; i < n; ++i) {
    squares += (0.5 * (n - 1) - i) * (0.5 * (n - 1) - i);
  }
  std::vector<double> weights;
  double sum = 0.0;
  for (int i = 0; i + 1 < n; ++i) {
    sum += (0.5 * (n - 1) - i) / squares;
    weights.push_back(sum);
  }
  return weights;
}

/// Largest modulus of the roots of c[0] z^n + ... + c[n], c[0] = 1.
double largest_root(const std::vector<double>& c) {
  const auto n = static_cast<Eigen::Index>(c.size()) - 1;
  Eigen::MatrixXd companion = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    companion(0, i) = -c[static_cast<std::size_t>(i + 1)];
    if (i > 0) {
      companion(i, i - 1) = 1.0;
    }
  }
  return spectral_radius(companion);
}

}  // namespace

Inertia::Inertia(const InertiaParameters& p, const Setting& setting)
    : mass_(p.mass), rate_(setting.rate), filter_(p.acceleration_filter, setting.rate) {
  require(std::isfinite(p.mass) && p.mass >= 0.0, "Inertia: mass must be finite and at least 0");
  require(is_positive(p.acceleration_filter), "Inertia: acceleration_filter must be above 0");
}

void Inertia::start(const PointState& hand) noexcept {
  before_ = hand.velocity;
  filter_.start(Vector3d::Zero());
}

Vector3d Inertia::force(const Felt& felt, FieldState& state) noexcept {
  const Vector3d acceleration = rate_ * (felt.hand.velocity - before_);
  before_ = felt.hand.velocity;
  state.velocity = felt.hand.velocity;
  return -felt.shares.damping * mass_ * filter_.next(acceleration);
}

void Inertia::adopt(const Inertia& before) noexcept {
  before_ = before.before_;
  filter_.adopt(before.filter_);
}

double largest_stable_mass(double cutoff, const InertiaLoop& loop) {
  require(is_positive(cutoff), "largest_stable_mass: cutoff must be above 0");
  require(loop.moved_mass > 0.0 && std::isfinite(loop.moved_mass),
          "InertiaLoop: moved_mass must be finite and above 0");
  require(loop.rate > 0.0 && std::isfinite(loop.rate),
          "InertiaLoop: rate must be finite and above 0");
  require(loop.velocity_window >= 2, "InertiaLoop: velocity_window must be at least 2");
  require(loop.force_delay >= 0, "InertiaLoop: force_delay must be at least 0");
  const double p = std::exp(-2.0 * std::numbers::pi * cutoff / loop.rate);
  const std::vector<double> q = weights_of_slope(loop.velocity_window);
  const auto delay = static_cast<std::size_t>(loop.force_delay);
  const auto stable = [&](double ratio) {
    std::vector<double> c(q.size() + 2 + delay, 0.0);
    c[0] = 1.0;
    c[1] -= p;
    for (std::size_t i = 0; i < q.size(); ++i) {
      const double gain = 0.5 * ratio * (1.0 - p) * q[i];
      c[i + 1 + delay] += gain;
      c[i + 2 + delay] += gain;
    }
    return largest_root(c) < 1.0;
  };
  double low = 0.0;
  double high = 1e-3;
  while (stable(high)) {
    low = high;
    high *= 1.25;
  }
  while (high - low > 1e-9 * high) {
    const double middle = 0.5 * (low + high);
    (stable(middle) ? low : high) = middle;
  }
  return low * loop.moved_mass;
}

}  // namespace haptrial::scene
