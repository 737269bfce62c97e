#include "analysis/device/motion_force.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "analysis/device/cogging.h"
#include "analysis/device/derivatives.h"
#include "analysis/device/least_squares.h"

namespace haptrial::analysis {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kWholeTurn = 2.0 * std::numbers::pi;
// Wide enough that steps of the encoders do not show in the acceleration; the degree keeps what a
// hand does at 5 Hz to a few parts in ten thousand.
constexpr double kDerivativeWindow = 0.05;  // half of that of the derivatives [s]
constexpr long kDegree = 7;
constexpr double kSureSpeed = 0.01;  // at which the sign of a velocity is sure [m/s]
constexpr double kBin = 1e-4;        // [m]
constexpr long kLeastSamples = 500;

struct Motion {
  std::vector<double> x, v, a, force;
};

/// @param number  of the driven axis
Motion motion_of(const PartRecord& part, const Excitation& excitation, long number, double age) {
  const int axis = excitation.axes()[static_cast<std::size_t>(number)];
  const long half = std::lround(kDerivativeWindow * excitation.rate());
  const long lag = std::lround(age * excitation.rate());
  const long per_axis = excitation.axis_ticks(CertificatePart::kMove);
  const long end = std::min((number + 1) * per_axis, static_cast<long>(part.measured.size()));
  const MatrixXd weights = derivative_weights(half, excitation.rate(), kDegree);
  VectorXd window(2 * half + 1);
  Motion all;
  for (long t = number * per_axis + half; t + half + lag < end; ++t) {
    for (long i = 0; i <= 2 * half; ++i) {
      window[i] = part.position[static_cast<std::size_t>(t - half + i)][axis];
    }
    const double v = weights.col(0).dot(window);
    if (std::abs(v) >= kSureSpeed) {
      all.x.push_back(weights.col(2).dot(window));
      all.v.push_back(v);
      all.a.push_back(weights.col(1).dot(window));
      all.force.push_back(part.measured[static_cast<std::size_t>(t + lag)][axis]);
    }
  }
  return all;
}

/// The part of the model without cogging: offset, friction, inertia.
double plain(const Motion& m, std::size_t i, const VectorXd& p) {
  return p[0] - p[1] * std::copysign(1.0, m.v[i]) - p[2] * m.a[i];
}

FittedParameters fit_plain(const Motion& m) {
  const auto n = static_cast<long>(m.x.size());
  return fit_least_squares(
      VectorXd::Zero(3), VectorXd::Constant(3, 0.1), n,
      [&m, n](const VectorXd& p, VectorXd& r) {
        for (long i = 0; i < n; ++i) {
          const auto k = static_cast<std::size_t>(i);
          r[i] = m.force[k] - plain(m, k, p);
        }
      },
      true);
}

FittedParameters fit_cogging(const Motion& m, const VectorXd& start, double span) {
  const auto n = static_cast<long>(m.x.size());
  VectorXd scale = VectorXd::Constant(6, 0.1);
  scale[5] = 0.05 / span;
  return fit_least_squares(
      start, scale, n,
      [&m, n](const VectorXd& p, VectorXd& r) {
        for (long i = 0; i < n; ++i) {
          const auto k = static_cast<std::size_t>(i);
          const double angle = kWholeTurn * p[5] * m.x[k];
          r[i] = m.force[k] - plain(m, k, p) - p[3] * std::cos(angle) - p[4] * std::sin(angle);
        }
      },
      true);
}

/// Start of the fit with cogging: the plain one's parameters and the sine that it leaves.
VectorXd with_sine(const Motion& m, const FittedParameters& plain_fit) {
  std::vector<double> left(m.x.size());
  for (std::size_t i = 0; i < m.x.size(); ++i) {
    left[i] = m.force[i] - plain(m, i, plain_fit.value);
  }
  const SineOverWay sine = strongest_sine(m.x, left);
  VectorXd start(6);
  start << plain_fit.value, sine.cosine, sine.sine, sine.frequency;
  return start;
}

void add_curves(const Motion& m, AxisMotion& axis) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  const auto [low, high] = std::minmax_element(m.x.begin(), m.x.end());
  const auto count = static_cast<std::size_t>((*high - *low) / kBin) + 1;
  std::vector<double> sums[2], counts[2];
  for (int side = 0; side < 2; ++side) {
    sums[side].resize(count);
    counts[side].resize(count);
  }
  for (std::size_t i = 0; i < m.x.size(); ++i) {
    const auto at = static_cast<std::size_t>((m.x[i] - *low) / kBin);
    const int side = m.v[i] > 0.0 ? 0 : 1;
    sums[side][at] += m.force[i] + axis.inertia.value * m.a[i];
    counts[side][at] += 1.0;
  }
  for (std::size_t i = 0; i < count; ++i) {
    axis.position.push_back(*low + (static_cast<double>(i) + 0.5) * kBin);
    axis.forward.push_back(counts[0][i] > 0.0 ? sums[0][i] / counts[0][i] : kNone);
    axis.backward.push_back(counts[1][i] > 0.0 ? sums[1][i] / counts[1][i] : kNone);
  }
}

AxisMotion fit_moved_axis(const Motion& m) {
  const auto [low, high] = std::minmax_element(m.x.begin(), m.x.end());
  const double span = *high - *low;
  const FittedParameters without = fit_plain(m);
  const FittedParameters with = fit_cogging(m, with_sine(m, without), span);
  const double variance = with.chi_squared / std::max(with.df, 1.0);
  const bool found = (without.chi_squared - with.chi_squared) / 2.0 > kClearCogging * variance;
  const FittedParameters& fit = found ? with : without;
  AxisMotion axis;
  axis.offset = fit.interval(0);
  axis.friction = fit.interval(1);
  axis.inertia = fit.interval(2);
  axis.least_cogging = std::sqrt(4.0 * kClearCogging * variance / static_cast<double>(m.x.size()));
  if (found) {
    VectorXd scale = VectorXd::Constant(6, 0.1);
    scale[5] = 0.05 / span;
    axis.cogging = fit.interval([](const VectorXd& p) { return std::hypot(p[3], p[4]); }, scale);
    axis.period = fit.interval([](const VectorXd& p) { return 1.0 / p[5]; }, scale);
  }
  add_curves(m, axis);
  return axis;
}

}  // namespace

std::vector<AxisMotion> identify_motion(const CertificateRecord& record,
                                        const Excitation& excitation) {
  std::vector<AxisMotion> axes;
  for (long axis = 0; axis < static_cast<long>(excitation.axes().size()); ++axis) {
    const Motion motion =
        motion_of(record.part(CertificatePart::kMove), excitation, axis, record.sensor_age);
    if (static_cast<long>(motion.x.size()) < kLeastSamples) {
      return {};
    }
    axes.push_back(fit_moved_axis(motion));
  }
  return axes;
}

}  // namespace haptrial::analysis
