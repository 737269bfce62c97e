#include "analysis/device/free_model.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "analysis/device/cogging.h"
#include "core/device/motor_faults.h"

namespace haptrial::analysis {
namespace {

using Eigen::VectorXd;

constexpr double kHundredHertz = 100.0;

double behind_dead_zone(double command, double zone) {
  const double size = std::abs(command);
  return size > zone ? command - zone * std::copysign(1.0, command) : 0.0;
}

/// The command behind its dead zone and a transmission that swings.
std::vector<double> transmitted(const FreeSignals& s, const FreeModel& model, const VectorXd& p) {
  std::vector<double> given(s.command.size());
  Eigen::Matrix2d step = Eigen::Matrix2d::Zero();
  if (model.resonance) {
    const int at = model.first_of_resonance();
    step = device::resonator_step(std::max(kHundredHertz * p[at], 5.0),
                                  std::clamp(p[at + 1], 0.005, 2.0), 1.0 / s.rate);
  }
  Eigen::Vector2d state = Eigen::Vector2d::Zero();
  for (std::size_t t = 0; t < given.size(); ++t) {
    const double zoned = behind_dead_zone(s.command[t], p[FreeModel::kDeadZone]);
    state[0] -= zoned;
    state = (step * state).eval();
    state[0] += zoned;
    given[t] = state[0];
  }
  return given;
}

/// Forces later by a delay in ms. They are held for a tick, so that a second difference sees the
/// mean of two.
std::vector<double> delayed(const FreeSignals& s, const std::vector<double>& given, double delay) {
  const auto n = static_cast<long>(given.size());
  const double late = std::clamp(1e-3 * delay, -0.002, FreeSignals::kMostDelay) * s.rate + 0.5;
  const double whole = std::floor(late);
  const double part = late - whole;
  const auto value = [&](long i) {
    return given[static_cast<std::size_t>(std::clamp(i, 0L, n - 1))];
  };
  std::vector<double> later(given.size());
  for (long t = 0; t < n; ++t) {
    const long at = t - static_cast<long>(whole);
    later[static_cast<std::size_t>(t)] = (1.0 - part) * value(at) + part * value(at - 1);
  }
  return later;
}

/// The acceleration at each tick.
std::vector<double> modelled_acceleration(const FreeSignals& s, const FreeModel& model,
                                          const VectorXd& p) {
  std::vector<double> made = delayed(s, transmitted(s, model, p), p[FreeModel::kDelay]);
  const int c = model.first_of_cogging();
  for (std::size_t t = 0; t < made.size(); ++t) {
    made[t] += p[FreeModel::kOffset] - p[FreeModel::kFriction] * std::copysign(1.0, s.speed[t]);
    if (model.cogging) {
      const double angle = 2.0 * std::numbers::pi * p[c + 2] * s.position[t];
      made[t] += p[c] * std::cos(angle) + p[c + 1] * std::sin(angle);
    }
    made[t] *= p[FreeModel::kMobility];
  }
  return made;
}

void add_residuals(const FreeSignals& s, const FreeModel& model, const VectorXd& p, VectorXd& r) {
  const std::vector<double> made = modelled_acceleration(s, model, p);
  const long reach = s.smoothing.size() / 2;
  for (std::size_t k = 0; k < s.windows.size(); ++k) {
    double sum = 0.0;
    for (long j = 0; j < s.smoothing.size(); ++j) {
      sum += s.smoothing[j] * made[static_cast<std::size_t>(s.windows[k] + j - reach)];
    }
    r[static_cast<long>(k)] = s.acceleration[k] - sum;
  }
}

FreeModel fitted(const FreeSignals& s, FreeModel model, const VectorXd& start) {
  const VectorXd scale = scale_of(s, model);
  model.fit = fit_least_squares(
      start, scale, static_cast<long>(s.windows.size()),
      [&](const VectorXd& p, VectorXd& r) { add_residuals(s, model, p, r); }, true);
  return model;
}

/// The delay has several valleys, since a command that keeps a handle near its place goes to and
/// fro as the handle does: delays are tried in turn, and the best one is refined.
FreeModel fit_rigid_model(const FreeSignals& s) {
  VectorXd best = VectorXd::Zero(FreeModel::kPlain);
  double least = std::numeric_limits<double>::infinity();
  for (double delay = 0.0; delay <= 1e3 * FreeSignals::kMostDelay; delay += 2.0) {
    const auto with_delay = [delay](const VectorXd& others) {
      VectorXd all(static_cast<int>(FreeModel::kPlain));
      all << others[0], delay, others.tail(3);
      return all;
    };
    const FittedParameters fit = fit_least_squares(
        Eigen::Vector4d(3.0, 0.1, 0.05, 0.0), Eigen::Vector4d(1.0, 0.1, 0.1, 0.1),
        static_cast<long>(s.windows.size()),
        [&](const VectorXd& p, VectorXd& r) { add_residuals(s, {}, with_delay(p), r); });
    if (fit.chi_squared < least) {
      least = fit.chi_squared;
      best = with_delay(fit.value);
    }
  }
  return fitted(s, {}, best);
}

bool explains_clearly_more(const FreeModel& richer, const FreeModel& than) {
  const double variance = richer.fit.chi_squared / std::max(richer.fit.df, 1.0);
  return (than.fit.chi_squared - richer.fit.chi_squared) / 2.0 > kClearCogging * variance;
}

FreeModel fit_free_cogging(const FreeSignals& s, const FreeModel& plain) {
  const VectorXd& p = plain.fit.value;
  VectorXd r(static_cast<long>(s.windows.size()));
  add_residuals(s, plain, p, r);
  std::vector<double> x, left;
  for (std::size_t k = 0; k < s.windows.size(); ++k) {
    x.push_back(s.position[static_cast<std::size_t>(s.windows[k])]);
    left.push_back(r[static_cast<long>(k)] / p[FreeModel::kMobility]);
  }
  const SineOverWay sine = strongest_sine(x, left);
  FreeModel model = plain;
  model.cogging = true;
  VectorXd start(model.count());
  start << p, sine.cosine, sine.sine, sine.frequency;
  return fitted(s, model, start);
}

FreeModel fit_free_resonance(const FreeSignals& s, const FreeModel& rigid) {
  const VectorXd& p = rigid.fit.value;
  FreeModel best = rigid;
  for (const double hertz : {40.0, 80.0, 160.0}) {
    FreeModel model = rigid;
    model.resonance = true;
    VectorXd start(model.count());
    start << p.head(FreeModel::kPlain), hertz / kHundredHertz, 0.2,
        p.tail(p.size() - FreeModel::kPlain);
    model = fitted(s, model, start);
    if (model.fit.chi_squared < best.fit.chi_squared) {
      best = std::move(model);
    }
  }
  return best;
}

}  // namespace

Eigen::VectorXd scale_of(const FreeSignals& signals, const FreeModel& model) {
  VectorXd scale = VectorXd::Constant(model.count(), 0.1);
  scale[FreeModel::kMobility] = scale[FreeModel::kDelay] = 1.0;
  if (model.cogging) {
    const auto [low, high] = std::ranges::minmax(signals.position);
    scale[model.count() - 1] = 0.05 / (high - low);
  }
  return scale;
}

FreeModel fit_free_model(const FreeSignals& signals) {
  FreeModel model = fit_rigid_model(signals);
  for (const auto& richer : {fit_free_cogging, fit_free_resonance}) {
    FreeModel tried = richer(signals, model);
    if (explains_clearly_more(tried, model)) {
      model = std::move(tried);
    }
  }
  return model;
}

}  // namespace haptrial::analysis
