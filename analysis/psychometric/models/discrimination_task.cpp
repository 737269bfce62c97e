#include "analysis/psychometric/models/discrimination_task.h"

#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <cmath>
#include <numbers>

#include "analysis/psychometric/models/detection.h"
#include "analysis/statistics/base/distributions.h"
#include "analysis/statistics/base/root.h"

namespace haptrial::analysis {
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
