#include "analysis/statistics/tests/bayes_factor.h"

#include <algorithm>
#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <cmath>
#include <limits>

namespace haptrial::analysis {
namespace {

constexpr double kDeviations = 12.0;  // beyond them a normal density is nothing
constexpr int kDepth = 10;            // of halvings
constexpr double kTolerance = 1e-10;
using Rule = boost::math::quadrature::gauss_kronrod<double, 31>;

/// The likelihood of t with the noncentrality m over that without, by the integral of the
/// noncentral t distribution over the scale of the sample,
///
///     exp(-df m² / (2 (t² + df))) ∫ y^df exp(-(y - a)² / 2) dy / ∫ y^df exp(-y² / 2) dy
///
/// with a = m t / sqrt(t² + df) and y from 0 to infinity: one peak, about which it is integrated.
double likelihood_ratio(double t, double df, double m) {
  const double square = t * t + df;
  const double a = m * t / std::sqrt(square);
  const double peak = 0.5 * (a + std::sqrt(a * a + 4.0 * df));
  const auto exponent = [&](double y) { return df * std::log(y) - 0.5 * (y - a) * (y - a); };
  const double highest = exponent(peak);
  const double width = kDeviations / std::sqrt(1.0 + df / (peak * peak));
  const auto share = [&](double y) { return std::exp(exponent(y) - highest); };
  const double sum = Rule::integrate(share, std::max(0.0, peak - width), peak, 3, kTolerance) +
                     Rule::integrate(share, peak, peak + width, 3, kTolerance);
  const double without = 0.5 * (df - 1.0) * M_LN2 + std::lgamma(0.5 * (df + 1.0));
  return sum * std::exp(highest - without - 0.5 * df * m * m / square);
}

/// Over effects from `low` to `high`.
double integral(double t, double df, double n, double scale, double low, double high) {
  const auto density = [&](double effect) {
    const double share = effect / scale;
    const double prior = 1.0 / (M_PI * scale * (1.0 + share * share));
    return prior * likelihood_ratio(t, df, effect * std::sqrt(n));
  };
  return low < high ? Rule::integrate(density, low, high, kDepth, kTolerance) : 0.0;
}

}  // namespace

Defined<double> bayes_factor(double t, double df, double n, Tail tail, double scale) {
  // The likelihood of an effect lies about t / sqrt(n), and is nothing beyond the spread.
  const double middle = t / std::sqrt(n);
  const double spread = kDeviations * (1.0 + std::abs(t) / std::sqrt(2.0 * df)) / std::sqrt(n);
  const double least = std::max(middle - spread, tail == Tail::kGreater ? 0.0 : -1e300);
  const double most = std::min(middle + spread, tail == Tail::kLess ? 0.0 : 1e300);
  const double turn = std::clamp(middle, std::min(least, most), std::max(least, most));
  const double sum = integral(t, df, n, scale, least, turn) + integral(t, df, n, scale, turn, most);
  const double factor = (tail == Tail::kTwoSided ? 1.0 : 2.0) * sum;
  if (std::isfinite(factor) && factor > 0.0) {
    return factor;
  }
  return Undefined{"the integral over effects is not finite"};
}

}  // namespace haptrial::analysis
