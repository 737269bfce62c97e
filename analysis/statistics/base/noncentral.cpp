#include "analysis/statistics/base/noncentral.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "analysis/statistics/base/distributions.h"
#include "analysis/statistics/base/solvers.h"

namespace haptrial::analysis {
namespace {

constexpr double kNegligible = 1e-22;  // of the largest Poisson weight
constexpr double kRest = 1e-18;        // of a sum, where the series ends
constexpr double kLargest = 1e9;       // squared statistic; the series grow with its root

/// The sums over j >= 0 of the Poisson weights w_j = poisson_power(j + shift, m) times the lower or
/// the upper tail of Beta(a + j, b) at x. Both are unimodal in j, so they end where what is left is
/// bounded by a geometric series.
struct PoissonBeta {
  double a;
  double b;
  double x;
  double y;  // 1 - x
  double m;
  double shift;

  double mode() const { return std::max(0.0, std::ceil(m - shift)); }

  double highest() const {
    double j = mode();
    for (double weight = 1.0; weight > kNegligible;) {
      j += 1.0;
      weight *= m / (j + shift);
    }
    return j;
  }

  double lowest() const {
    double j = mode();
    for (double weight = 1.0; weight > kNegligible && j > 0.0; j -= 1.0) {
      weight *= (j + shift) / m;
    }
    return j;
  }

  // I_x(a + j, b) - I_x(a + j + 1, b)
  double step_at(double j) const { return beta_power(a + j, b, x, y) / (a + j); }

  // The highest j up to `top` whose step is large enough to go on from; 0 if none is.
  double reached(double top) const {
    constexpr double kLost = 1e-290;  // below, a recurrence would have lost its digits
    if (step_at(top) >= kLost) {
      return top;
    }
    double low = std::clamp(std::ceil((x * (a + b) - a - 1.0) / y), 0.0, top);  // largest step
    double high = top;
    while (high - low > 1.0) {
      const double middle = std::floor(0.5 * (low + high));
      (step_at(middle) >= kLost ? low : high) = middle;
    }
    return low;
  }

  // Downwards: I_x(a + j - 1, b) adds a step to I_x(a + j, b).
  double lower() const {
    double j = reached(highest());
    double weight = poisson_power(j + shift, m);
    double tail = beta_tails(a + j, b, x, y).lower;
    double step = step_at(j);
    double term = weight * tail;
    double sum = term;
    while (j > 0.0 && weight > 0.0) {
      step *= (a + j) / (x * (a + b + j - 1.0));
      weight *= (j + shift) / m;
      j -= 1.0;
      tail += step;
      const double ratio = term > 0.0 ? weight * tail / term : 1.0;
      term = weight * tail;
      sum += term;
      if (ratio < 1.0 && term * ratio < kRest * sum * (1.0 - ratio)) {
        break;
      }
    }
    return sum;
  }

  // Upwards: the upper tail of a + j + 1 adds a step to that of a + j, and is at most 1.
  double upper() const {
    const double peak = mode();
    double j = lowest();
    double weight = poisson_power(j + shift, m);
    double tail = beta_tails(a + j, b, x, y).upper;
    double step = step_at(j);
    double sum = weight * tail;
    while (true) {
      tail += step;
      step *= x * (a + b + j) / (a + j + 1.0);
      j += 1.0;
      weight *= m / (j + shift);
      sum += weight * tail;
      const double ratio = m / (j + 1.0 + shift);
      if (j > peak && !(weight * ratio > kRest * sum * (1.0 - ratio))) {
        return sum;
      }
    }
  }
};

double normal_upper(double z) { return 0.5 * std::erfc(z / std::numbers::sqrt2); }

double in_unit(double p) { return std::clamp(p, 0.0, 1.0); }

// Zero of a falling function of the noncentrality, above low.
double falling_root(const std::function<double(double)>& f, double low, double width) {
  double high = low + width;
  while (f(high) > 0.0) {
    low = high;
    width *= 2.0;
    high += width;
  }
  return find_root(f, low, high);
}

}  // namespace

Tails noncentral_t(double t, double df, double delta) {
  if (t < 0.0) {
    const Tails mirrored = noncentral_t(-t, df, -delta);
    return {mirrored.upper, mirrored.lower};
  }
  const double square = t * t;
  const double x = square / (df + square);
  const double y = df / (df + square);
  const double m = 0.5 * delta * delta;
  if (m == 0.0) {
    const BetaTails tails = beta_tails(0.5, 0.5 * df, x, y);
    return {0.5 + 0.5 * tails.lower, 0.5 * tails.upper};
  }
  if (t == 0.0) {
    return {normal_upper(delta), normal_upper(-delta)};
  }
  const PoissonBeta even{0.5, 0.5 * df, x, y, m, 0.0};
  const PoissonBeta odd{1.0, 0.5 * df, x, y, m, 0.5};
  const double sign = delta > 0.0 ? 1.0 : -1.0;
  return {in_unit(normal_upper(delta) + 0.5 * (even.lower() + sign * odd.lower())),
          in_unit(0.5 * (even.upper() + sign * odd.upper()))};
}

Tails noncentral_f(double f, double df_numerator, double df_denominator, double lambda) {
  const double scaled = df_numerator * f;
  const double x = scaled / (df_denominator + scaled);
  const double y = df_denominator / (df_denominator + scaled);
  const double a = 0.5 * df_numerator;
  const double b = 0.5 * df_denominator;
  if (lambda == 0.0 || x == 0.0) {
    const BetaTails tails = beta_tails(a, b, x, y);
    return {tails.lower, tails.upper};
  }
  const PoissonBeta sum{a, b, x, y, 0.5 * lambda, 0.0};
  return {in_unit(sum.lower()), in_unit(sum.upper())};
}

Defined<NoncentralityLimits> noncentral_t_limits(double t, double df, double level) {
  if (!(t * t <= kLargest)) {
    return Undefined{"the effect is above 30000 standard errors, too large for its interval"};
  }
  if (t < 0.0) {
    const auto mirrored = noncentral_t_limits(-t, df, level);
    return NoncentralityLimits{-mirrored->high, -mirrored->low};
  }
  const double tail = 0.5 * (1.0 - level);
  const double width = 1.0 + t / std::sqrt(df);
  const auto above = [&](double delta) { return noncentral_t(t, df, delta).lower - tail; };
  const auto below = [&](double delta) { return noncentral_t(t, df, -delta).upper - tail; };
  return NoncentralityLimits{-falling_root(below, -t, width), falling_root(above, t, width)};
}

Defined<NoncentralityLimits> noncentral_f_limits(double f, double df_numerator,
                                                 double df_denominator, double level) {
  const double start = df_numerator * f;
  if (!(start <= kLargest)) {
    return Undefined{"F is too large for its interval"};
  }
  const double tail = 0.5 * (1.0 - level);
  const auto at = [&](double lambda) {
    return noncentral_f(f, df_numerator, df_denominator, lambda);
  };
  NoncentralityLimits limits;
  // The upper tail rises with the noncentrality, the lower one falls.
  if (at(0.0).upper < tail) {
    double high = start + 1.0;
    while (at(high).upper < tail) {
      high *= 2.0;
    }
    limits.low = find_root([&](double l) { return at(l).upper - tail; }, 0.0, high);
  }
  if (at(0.0).lower > tail) {
    limits.high = falling_root([&](double l) { return at(l).lower - tail; }, 0.0, start + 1.0);
  }
  return limits;
}

}  // namespace haptrial::analysis
