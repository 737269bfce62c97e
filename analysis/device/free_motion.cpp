#include "analysis/device/free_motion.h"

#include <algorithm>
#include <cmath>

#include "analysis/device/derivatives.h"
#include "analysis/device/free_model.h"
#include "analysis/device/frequency_response.h"

namespace haptrial::analysis {
namespace {

using Eigen::VectorXd;

constexpr double kWindow = 0.012;     // half of that of the derivatives [s]
constexpr double kLeastSpeed = 0.01;  // at which the sign of a velocity is sure [m/s]
constexpr long kEvery = 4;            // ticks from one window to the next
constexpr long kLeastWindows = 200;

/// @param number  of the driven axis
FreeSignals signals_of(const PartRecord& part, const Excitation& excitation, long number,
                       CertificatePart which) {
  const int axis = excitation.axes()[static_cast<std::size_t>(number)];
  const long half = std::max(3L, std::lround(kWindow * excitation.rate()));
  const Eigen::MatrixXd weights = derivative_weights(half, excitation.rate(), 5);
  const long per_axis = excitation.axis_ticks(which);
  const auto begin = static_cast<std::size_t>(number * per_axis);
  const std::size_t end =
      std::min(begin + static_cast<std::size_t>(per_axis), part.position.size());
  FreeSignals s{
      excitation.rate(), {}, {}, {}, smoothing_of(weights.col(1), excitation.rate()), {}, {}};
  if (begin >= end) {
    return s;
  }
  const auto n = static_cast<long>(end - begin);
  VectorXd x(n);
  s.command.resize(static_cast<std::size_t>(n));
  s.position.resize(static_cast<std::size_t>(n));
  for (long t = 0; t < n; ++t) {
    x[t] = part.position[begin + static_cast<std::size_t>(t)][axis];
    s.position[static_cast<std::size_t>(t)] = x[t];
    s.command[static_cast<std::size_t>(t)] =
        part.command[begin + static_cast<std::size_t>(t)][axis];
  }
  s.speed.assign(static_cast<std::size_t>(n), 0.0);
  for (long t = half; t + half < n; ++t) {
    s.speed[static_cast<std::size_t>(t)] = weights.col(0).dot(x.segment(t - half, 2 * half + 1));
  }
  const long first = 2 * half + std::lround(FreeSignals::kMostDelay * excitation.rate()) + 2;
  for (long t = first; t + 2 * half < n; t += kEvery) {
    bool moves = true;
    for (long i = -half; i <= half; ++i) {
      moves = moves && std::abs(s.speed[static_cast<std::size_t>(t + i)]) >= kLeastSpeed;
    }
    if (moves) {
      s.windows.push_back(t);
      s.acceleration.push_back(weights.col(1).dot(x.segment(t - half, 2 * half + 1)));
    }
  }
  return s;
}

Interval in_units(Interval i, double factor) {
  return {factor * i.value, factor * i.low, factor * i.high, i.df};
}

FreeMotion fit_free_axis(const FreeSignals& s) {
  const FreeModel model = fit_free_model(s);
  const FittedParameters& fit = model.fit;
  FreeMotion axis;
  axis.mobility = fit.interval(FreeModel::kMobility);
  axis.delay = in_units(fit.interval(FreeModel::kDelay), 1e-3);
  axis.friction = fit.interval(FreeModel::kFriction);
  axis.dead_zone = fit.interval(FreeModel::kDeadZone);
  axis.offset = fit.interval(FreeModel::kOffset);
  for (double* part : {&axis.dead_zone.value, &axis.dead_zone.low, &axis.dead_zone.high}) {
    *part = std::max(*part, 0.0);
  }
  const VectorXd scale = scale_of(s, model);
  if (const int r = model.first_of_resonance(); model.resonance) {
    axis.resonance = in_units(fit.interval(r), 100.0);
    axis.damping = fit.interval(r + 1);
    axis.bandwidth = fit.interval(
        [r](const VectorXd& p) { return 100.0 * p[r] * bandwidth_per_resonance(p[r + 1]); }, scale);
  }
  if (const int c = model.first_of_cogging(); model.cogging) {
    axis.cogging =
        fit.interval([c](const VectorXd& p) { return std::hypot(p[c], p[c + 1]); }, scale);
    axis.period = fit.interval([c](const VectorXd& p) { return 1.0 / p[c + 2]; }, scale);
  }
  return axis;
}

Interval inverse(const Interval& i) { return {1.0 / i.value, 1.0 / i.high, 1.0 / i.low, i.df}; }

/// Interval whose ends lie as far from its value as those of its parts say, if they are
/// independent.
Interval spread(double value, double first, double second, double df) {
  const double half = std::hypot(first, second);
  return {value, value - half, value + half, df};
}

}  // namespace

std::vector<FreeMotion> identify_free_motion(const CertificateRecord& record,
                                             const Excitation& excitation, CertificatePart part) {
  std::vector<FreeMotion> axes;
  for (long axis = 0; axis < static_cast<long>(excitation.axes().size()); ++axis) {
    const FreeSignals signals = signals_of(record.part(part), excitation, axis, part);
    if (static_cast<long>(signals.windows.size()) < kLeastWindows) {
      return {};
    }
    axes.push_back(fit_free_axis(signals));
  }
  return axes;
}

WeighedMotion weigh(const FreeMotion& free, const FreeMotion& loaded, double mass) {
  const Interval light = inverse(free.mobility);    // inertia / gain [kg]
  const Interval heavy = inverse(loaded.mobility);  // (inertia + mass) / gain [kg]
  const double difference = heavy.value - light.value;
  const double gain = mass / difference;
  const double to_light = 0.5 * (light.high - light.low);
  const double to_heavy = 0.5 * (heavy.high - heavy.low);
  const double per = gain / difference;  // change of the gain with either [1/kg]
  const double df = std::min(light.df, heavy.df);
  WeighedMotion found;
  found.gain = spread(gain, per * to_light, per * to_heavy, df);
  found.inertia =
      spread(gain * light.value, per * heavy.value * to_light, per * light.value * to_heavy, df);
  return found;
}

}  // namespace haptrial::analysis
