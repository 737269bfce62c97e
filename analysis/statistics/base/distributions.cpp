#include "analysis/statistics/base/distributions.h"

#include <gsl/gsl_cdf.h>
#include <gsl/gsl_randist.h>
#include <gsl/gsl_sf_gamma.h>
#include <gsl/gsl_sf_log.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace haptrial::analysis {

double f_upper_tail(double f, double df_numerator, double df_denominator) {
  return gsl_cdf_fdist_Q(f, df_numerator, df_denominator);
}

// GSL's own tail of t is an expansion above 30 degrees of freedom, wrong by 1e-8 of itself far out;
// T squared is F.
double t_upper_tail(double t, double df) {
  const double tail = 0.5 * gsl_cdf_fdist_Q(t * t, 1.0, df);
  return t < 0.0 ? 1.0 - tail : tail;
}

// GSL's quantile has about seven digits, and fewer far out. Newton's steps add the rest: in the
// logarithms of the tail and of t, where the curve bends one way only, they cannot go astray.
double t_quantile(double probability, double df) {
  if (probability == 0.5) {
    return 0.0;
  }
  const double tail = std::min(probability, 1.0 - probability);
  double t = gsl_cdf_tdist_Qinv(tail, df);
  if (!(t > 0.0) || !std::isfinite(t)) {
    t = 1.0;
  }
  for (int i = 0; i < 500; ++i) {
    const double found = t_upper_tail(t, df);
    const double slope = t * gsl_ran_tdist_pdf(t, df) / found;
    const double step = found > 0.0 ? std::clamp(std::log(found / tail) / slope, -1.0, 1.0) : -1.0;
    t *= std::exp(step);
    if (std::abs(step) < 1e-15) {
      break;
    }
  }
  return probability < 0.5 ? -t : t;
}

double normal_upper_tail(double z) { return gsl_cdf_ugaussian_Q(z); }

double normal_quantile(double probability) { return gsl_cdf_ugaussian_Pinv(probability); }

double chi_squared_upper_tail(double x, double df) { return gsl_cdf_chisq_Q(x, df); }

namespace {

constexpr double kTwoPi = 2.0 * std::numbers::pi;

// a log(ratio) - u, where ratio = 1 + u / a, without the digits that cancel when u is small beside
// a.
double deviance(double a, double u, double ratio) {
  constexpr double kSmall = 0.5;
  return std::abs(u) < kSmall * a ? a * gsl_sf_log_1plusx_mx(u / a) : a * std::log(ratio) - u;
}

// I_x(a, b) / beta_power(a, b, x, y) * a, for x below about the mean of the distribution.
double continued_fraction(double a, double b, double x) {
  constexpr double kTiny = 1e-300;
  constexpr int kMost = 200000;  // about the square root of the larger parameter is needed
  const auto away = [](double v) { return std::abs(v) < kTiny ? kTiny : v; };
  double c = 1.0;
  double d = 1.0 / away(1.0 - (a + b) * x / (a + 1.0));
  double h = d;
  for (int i = 1; i < kMost; ++i) {
    const double m = i;
    const double even = m * (b - m) * x / ((a + 2.0 * m - 1.0) * (a + 2.0 * m));
    d = 1.0 / away(1.0 + even * d);
    c = away(1.0 + even / c);
    h *= d * c;
    const double odd = -(a + m) * (a + b + m) * x / ((a + 2.0 * m) * (a + 2.0 * m + 1.0));
    d = 1.0 / away(1.0 + odd * d);
    c = away(1.0 + odd / c);
    const double step = d * c;
    h *= step;
    if (std::abs(step - 1.0) < 1e-16) {
      break;
    }
  }
  return h;
}

}  // namespace

double beta_power(double a, double b, double x, double y) {
  if (x <= 0.0 || y <= 0.0) {
    return 0.0;
  }
  const double n = a + b;
  const double u = b * x - a * y;  // n x - a
  const double exponent = deviance(a, u, x * n / a) + deviance(b, -u, y * n / b);
  const double gammas = gsl_sf_gammastar(n) / (gsl_sf_gammastar(a) * gsl_sf_gammastar(b));
  return std::exp(exponent) * std::sqrt(a / n * b / kTwoPi) * gammas;
}

double poisson_power(double k, double m) {
  if (k == 0.0) {
    return std::exp(-m);
  }
  return std::exp(deviance(k, m - k, m / k)) / (std::sqrt(kTwoPi * k) * gsl_sf_gammastar(k));
}

BetaTails beta_tails(double a, double b, double x, double y) {
  if (x <= 0.0) {
    return {0.0, 1.0};
  }
  if (y <= 0.0) {
    return {1.0, 0.0};
  }
  const double power = beta_power(a, b, x, y);
  if (x * (a + b + 2.0) < a + 1.0) {
    const double lower = power / a * continued_fraction(a, b, x);
    return {lower, 1.0 - lower};
  }
  const double upper = power / b * continued_fraction(b, a, y);
  return {1.0 - upper, upper};
}

}  // namespace haptrial::analysis
