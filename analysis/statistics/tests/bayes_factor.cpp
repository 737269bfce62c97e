#include "analysis/statistics/tests/bayes_factor.h"

#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <cmath>

#include "analysis/statistics/base/distributions.h"

namespace haptrial::analysis {
namespace {

/// Share of the posterior of the effect that lies on a directed test's side, for a normal prior of
/// the effect whose variance is (spread - 1) / n: Student's t, as the scale is integrated out.
double share_on_side(double t, double df, double spread, Tail tail) {
  if (tail == Tail::kTwoSided) {
    return 0.5;
  }
  const double sum = df + t * t / spread;
  const double a = t * std::sqrt((1.0 - 1.0 / spread) * (df + 1.0) / sum);
  return t_upper_tail(tail == Tail::kGreater ? -a : a, df + 1.0);
}

}  // namespace

/// A Cauchy prior is a mixture of normal ones with variances (scale / u)², u from the half of a
/// standard normal distribution (Rouder et al. 2009, eq. 1); integrated over log u.
Defined<double> bayes_factor(double t, double df, double n, Tail tail, double scale) {
  constexpr double kLow = -40.0, kHigh = 3.0;  // of log u: beyond, nothing is left
  constexpr int kDepth = 12;                   // of halvings
  constexpr double kTolerance = 1e-10;
  const auto density = [&](double log_u) {
    const double u = std::exp(log_u);
    const double spread = 1.0 + n * (scale / u) * (scale / u);
    const double ratio =
        0.5 * (df + 1.0) * (std::log1p(t * t / df) - std::log1p(t * t / (df * spread))) -
        0.5 * std::log(spread);
    const double prior = std::sqrt(2.0 / M_PI) * std::exp(log_u - 0.5 * u * u + ratio);
    return prior > 0.0 ? 2.0 * share_on_side(t, df, spread, tail) * prior : 0.0;
  };
  using Rule = boost::math::quadrature::gauss_kronrod<double, 31>;
  const double factor = Rule::integrate(density, kLow, kHigh, kDepth, kTolerance);
  if (std::isfinite(factor) && factor > 0.0) {
    return factor;
  }
  return Undefined{"the integral over effects is not finite"};
}

}  // namespace haptrial::analysis
