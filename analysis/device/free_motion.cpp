#include "analysis/device/free_motion.h"

#include <algorithm>
#include <cmath>

#include "analysis/device/derivatives.h"
#include "analysis/device/least_squares.h"

namespace haptrial::analysis {
namespace {

using Eigen::VectorXd;

constexpr double kWindow = 0.012;     // half of that of the derivatives [s]
constexpr double kLeastSpeed = 0.01;  // at which the sign of a velocity is sure [m/s]
constexpr long kEvery = 4;            // ticks from one window to the next
constexpr long kLeastWindows = 200;
constexpr double kMostDelay = 0.02;  // [s]

/// Signals along one axis, and the windows in which the handle never stood still.
struct Signals {
  double rate;
  std::vector<double> command, speed;
  VectorXd smoothing;                // over second differences
  std::vector<long> windows;         // their middles
  std::vector<double> acceleration;  // of each
};

/// @param number  of the driven axis
Signals signals_of(const PartRecord& part, const Excitation& excitation, long number,
                   CertificatePart which) {
  const int axis = excitation.axes()[static_cast<std::size_t>(number)];
  const long half = std::max(3L, std::lround(kWindow * excitation.rate()));
  const Eigen::MatrixXd weights = derivative_weights(half, excitation.rate(), 5);
  const long per_axis = excitation.axis_ticks(which);
  const auto begin = static_cast<std::size_t>(number * per_axis);
  const std::size_t end =
      std::min(begin + static_cast<std::size_t>(per_axis), part.position.size());
  Signals s{excitation.rate(), {}, {}, smoothing_of(weights.col(1), excitation.rate()), {}, {}};
  if (begin >= end) {
    return s;
  }
  const auto n = static_cast<long>(end - begin);
  VectorXd x(n);
  s.command.resize(static_cast<std::size_t>(n));
  for (long t = 0; t < n; ++t) {
    x[t] = part.position[begin + static_cast<std::size_t>(t)][axis];
    s.command[static_cast<std::size_t>(t)] =
        part.command[begin + static_cast<std::size_t>(t)][axis];
  }
  s.speed.assign(static_cast<std::size_t>(n), 0.0);
  for (long t = half; t + half < n; ++t) {
    s.speed[static_cast<std::size_t>(t)] = weights.col(0).dot(x.segment(t - half, 2 * half + 1));
  }
  const long first = 2 * half + std::lround(kMostDelay * excitation.rate()) + 2;
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

double behind_dead_zone(double command, double zone) {
  const double size = std::abs(command);
  return size > zone ? command - zone * std::copysign(1.0, command) : 0.0;
}

/// Model of the acceleration without smoothing at each tick. A command is held for a tick, so that
/// a second difference sees the mean of two.
/// @param p  mobility, delay [ms], friction, dead zone, offset [commanded N]
std::vector<double> modelled_acceleration(const Signals& s, const VectorXd& p) {
  const auto n = static_cast<long>(s.command.size());
  std::vector<double> zoned(s.command.size()), made(s.command.size());
  for (std::size_t t = 0; t < zoned.size(); ++t) {
    zoned[t] = behind_dead_zone(s.command[t], p[3]);
  }
  const double late = std::clamp(1e-3 * p[1], -0.002, kMostDelay) * s.rate + 0.5;
  const double whole = std::floor(late);
  const double part = late - whole;
  for (long t = 0; t < n; ++t) {
    const long at = t - static_cast<long>(whole);
    const auto value = [&](long i) {
      return zoned[static_cast<std::size_t>(std::clamp(i, 0L, n - 1))];
    };
    const double force = (1.0 - part) * value(at) + part * value(at - 1);
    const double speed = s.speed[static_cast<std::size_t>(t)];
    made[static_cast<std::size_t>(t)] = p[0] * (force - p[2] * std::copysign(1.0, speed) + p[4]);
  }
  return made;
}

FreeMotion fit_free_axis(const Signals& s) {
  const auto n = static_cast<long>(s.windows.size());
  const long reach = s.smoothing.size() / 2;
  const auto residuals = [&](const VectorXd& p, VectorXd& r) {
    const std::vector<double> made = modelled_acceleration(s, p);
    for (long i = 0; i < n; ++i) {
      const auto k = static_cast<std::size_t>(i);
      double sum = 0.0;
      for (long j = 0; j < s.smoothing.size(); ++j) {
        sum += s.smoothing[j] * made[static_cast<std::size_t>(s.windows[k] + j - reach)];
      }
      r[i] = s.acceleration[k] - sum;
    }
  };
  const VectorXd start = (VectorXd(5) << 3.0, 2.0, 0.1, 0.05, 0.0).finished();
  const VectorXd scale = (VectorXd(5) << 1.0, 1.0, 0.1, 0.1, 0.1).finished();
  const FittedParameters fit = fit_least_squares(start, scale, n, residuals, true);
  FreeMotion found{fit.interval(0), fit.interval(1), fit.interval(2), fit.interval(3),
                   fit.interval(4)};
  for (double* part : {&found.delay.value, &found.delay.low, &found.delay.high}) {
    *part *= 1e-3;
  }
  for (double* part : {&found.dead_zone.value, &found.dead_zone.low, &found.dead_zone.high}) {
    *part = std::max(*part, 0.0);
  }
  return found;
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
    const Signals signals = signals_of(record.part(part), excitation, axis, part);
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
