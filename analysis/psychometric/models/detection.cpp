#include "analysis/psychometric/models/detection.h"

#include <gsl/gsl_cdf.h>
#include <gsl/gsl_integration.h>

#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <cmath>
#include <memory>
#include <numbers>
#include <stdexcept>
#include <string>

#include "analysis/statistics/base/distributions.h"
#include "analysis/statistics/base/solvers.h"

namespace haptrial::analysis {
namespace {

double normal_density(double z) {
  return std::exp(-0.5 * z * z) / std::sqrt(2.0 * std::numbers::pi);
}

struct Rate {
  double value;
  double trials;

  double z() const { return normal_quantile(value); }
  /// Variance of the rate's normal quantile, by the delta method.
  double variance() const {
    const double density = normal_density(z());
    return value * (1.0 - value) / (trials * density * density);
  }
};

Defined<Rate> corrected(double count, double others, RateCorrection correction, const char* kind) {
  const double trials = count + others;
  if (trials == 0.0) {
    return Undefined{std::string("there are no ") + kind + " trials"};
  }
  switch (correction) {
    case RateCorrection::kLogLinear:
      return Rate{(count + 0.5) / (trials + 1.0), trials + 1.0};
    case RateCorrection::kExtremes:
      return Rate{count == 0.0    ? 0.5 / trials
                  : others == 0.0 ? 1.0 - 0.5 / trials
                                  : count / trials,
                  trials};
    case RateCorrection::kNone:
      break;
  }
  if (count == 0.0 || others == 0.0) {
    return Undefined{std::string("the rate of \"yes\" in ") + kind +
                     " trials is 0 or 1 and not corrected"};
  }
  return Rate{count / trials, trials};
}

void check_counts(const DetectionCounts& counts, double level) {
  for (const double count :
       {counts.hits, counts.misses, counts.false_alarms, counts.correct_rejections}) {
    if (!(std::isfinite(count) && count >= 0.0)) {
      throw std::invalid_argument("counts of a detection must be finite and not negative");
    }
  }
  if (!(level > 0.0 && level < 1.0)) {
    throw std::invalid_argument("level of an interval must lie inside (0, 1)");
  }
}

struct Choice {
  double d_prime;
  double others;
};

double choice_density(double x, void* choice) {
  const auto& c = *static_cast<const Choice*>(choice);
  return normal_density(x - c.d_prime) * std::pow(gsl_cdf_ugaussian_P(x), c.others);
}

}  // namespace

Defined<Detection> detection(const DetectionCounts& counts, RateCorrection correction,
                             double level) {
  check_counts(counts, level);
  const auto hits = corrected(counts.hits, counts.misses, correction, "signal");
  const auto alarms =
      corrected(counts.false_alarms, counts.correct_rejections, correction, "noise");
  if (!hits || !alarms) {
    return Undefined{!hits ? hits.because() : alarms.because()};
  }
  Detection d;
  d.hit_rate = hits->value;
  d.false_alarm_rate = alarms->value;
  d.d_prime = hits->z() - alarms->z();
  const double sum = hits->z() + alarms->z();
  const bool rounding = std::abs(sum) <= 1e-15 * std::abs(hits->z());
  d.criterion = rounding ? 0.0 : -0.5 * sum;
  d.log_beta = d.criterion * (hits->z() - alarms->z());
  d.error = std::sqrt(hits->variance() + alarms->variance());
  const double z = normal_quantile(0.5 + 0.5 * level);
  d.low = d.d_prime - z * d.error;
  d.high = d.d_prime + z * d.error;
  return d;
}

double forced_choice_share(double d_prime, int alternatives) {
  if (alternatives < 2 || alternatives > 1000) {
    throw std::invalid_argument("alternatives must lie in 2 .. 1000");
  }
  Choice choice{d_prime, static_cast<double>(alternatives - 1)};
  gsl_function function{choice_density, &choice};
  constexpr std::size_t kParts = 200;
  const std::unique_ptr<gsl_integration_workspace, decltype(&gsl_integration_workspace_free)> space(
      gsl_integration_workspace_alloc(kParts), gsl_integration_workspace_free);
  double share = 0.0, error = 0.0;
  gsl_integration_qag(&function, d_prime - 10.0, d_prime + 10.0, 1e-14, 1e-12, kParts,
                      GSL_INTEG_GAUSS61, space.get(), &share, &error);
  return share;
}

Defined<double> forced_choice_d_prime(double share, int alternatives) {
  if (!(share > 0.0 && share < 1.0)) {
    return Undefined{"the share of right answers is 0 or 1"};
  }
  const auto beyond = [&](double d) { return forced_choice_share(d, alternatives) - share; };
  double low = -1.0, high = 1.0;
  for (; beyond(low) > 0.0 && low > -60.0; low *= 2.0) {
  }
  for (; beyond(high) < 0.0 && high < 60.0; high *= 2.0) {
  }
  if (beyond(low) > 0.0 || beyond(high) < 0.0) {
    return Undefined{"the share of right answers is too close to 0 or 1"};
  }
  return find_root(beyond, low, high);
}

namespace {

double below(double z) { return normal_upper_tail(-z); }

/// Frijters 1979, Journal of Mathematical Psychology 19.
double oddity_share(double d) {
  const auto density = [d](double z) {
    const double shift = d * std::numbers::sqrt2 / std::numbers::sqrt3;
    const double far = -z * std::numbers::sqrt3;
    return (below(far + shift) + below(far - shift)) * std::exp(-0.5 * z * z);
  };
  constexpr double kFar = 12.0;
  using Rule = boost::math::quadrature::gauss_kronrod<double, 31>;
  return std::sqrt(2.0 / std::numbers::pi) * Rule::integrate(density, 0.0, kFar, 8, 1e-12);
}

double both_or_neither(double a, double b) { return below(a) * below(b) + below(-a) * below(-b); }

}  // namespace

double task_share(DiscriminationTask task, double d, int alternatives) {
  switch (task) {
    case DiscriminationTask::kOneInterval:
      return below(d / 2.0);
    case DiscriminationTask::kOddity:
      return oddity_share(d);
    case DiscriminationTask::kAbx:
      return both_or_neither(d / std::numbers::sqrt2, d / std::sqrt(6.0));
    case DiscriminationTask::kSameDifferent:
      return both_or_neither(d / 2.0, d / 2.0);
    case DiscriminationTask::kForcedChoice:
      break;
  }
  return forced_choice_share(d, alternatives);
}

Defined<double> task_d_prime(DiscriminationTask task, double share, int alternatives) {
  if (task == DiscriminationTask::kForcedChoice) {
    return forced_choice_d_prime(share, alternatives);
  }
  if (!(share > 0.0 && share < 1.0)) {
    return Undefined{"the share of right answers is 0 or 1"};
  }
  if (task == DiscriminationTask::kOneInterval) {
    return std::numbers::sqrt2 * *forced_choice_d_prime(share, 2);
  }
  constexpr double kMost = 30.0;
  if (share <= task_share(task, 0.0, alternatives)) {
    return 0.0;
  }
  if (share >= task_share(task, kMost, alternatives)) {
    return Undefined{"the share of right answers is too close to 1"};
  }
  return find_root([&](double d) { return task_share(task, d, alternatives) - share; }, 0.0, kMost);
}

}  // namespace haptrial::analysis
