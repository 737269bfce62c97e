#include "analysis/statistics/relation/correlation.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <vector>

#include "analysis/statistics/base/descriptive.h"
#include "analysis/statistics/base/distributions.h"
#include "analysis/statistics/relation/centered_design.h"

namespace haptrial::analysis {
namespace {

Defined<double> pearson_r(std::span<const double> a, std::span<const double> b) {
  const auto ma = moments(a);
  const auto mb = moments(b);
  if (!ma || !mb) {
    return Undefined{!ma ? ma.because() : mb.because()};
  }
  if (ma->count < 3) {
    return Undefined{"there are fewer than three pairs"};
  }
  if (ma->squares <= rounding_of(a) || mb->squares <= rounding_of(b)) {
    return Undefined{"one of the variables does not vary"};
  }
  double products = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    products += ((a[i] - ma->origin) - ma->offset) * ((b[i] - mb->origin) - mb->offset);
  }
  return std::clamp(products / (std::sqrt(ma->squares) * std::sqrt(mb->squares)), -1.0, 1.0);
}

double p_of_t(double r, double pairs) {
  const double df = pairs - 2.0;
  const double rest = (1.0 - r) * (1.0 + r);
  return rest <= 0.0 ? 0.0
                     : std::min(1.0, 2.0 * t_upper_tail(std::abs(r) * std::sqrt(df / rest), df));
}

// @param spread  variance of atanh(r), times n - 3.
Defined<Correlation::Interval> fisher(double r, double pairs, double spread, double level) {
  if (pairs < 4.0) {
    return Undefined{"an interval needs at least four pairs"};
  }
  const double half = normal_quantile(0.5 * (1.0 + level)) * std::sqrt(spread / (pairs - 3.0));
  const double z = std::atanh(r);
  return Correlation::Interval{std::tanh(z - half), std::tanh(z + half)};
}

// Twice a rank is a whole number.
std::vector<long> doubled(const std::vector<double>& ranks) {
  std::vector<long> result(ranks.size());
  std::transform(ranks.begin(), ranks.end(), result.begin(),
                 [](double r) { return std::lround(2.0 * r); });
  return result;
}

// The share of all arrangements whose correlation is at least as strong, of either sign.
double p_of_arrangements(const std::vector<double>& a, const std::vector<double>& b) {
  const std::vector<long> fixed = doubled(a);
  std::vector<long> moving = doubled(b);
  const auto n = static_cast<long>(a.size());
  const long middle = n * (n + 1) * (n + 1);  // of the sum of products: (sum of 2 ranks)² / n
  const auto distance = [&] {
    return std::abs(std::inner_product(fixed.begin(), fixed.end(), moving.begin(), 0L) - middle);
  };
  const long found = distance();
  std::sort(moving.begin(), moving.end());
  long all = 0;
  long as_strong = 0;
  do {
    ++all;
    as_strong += distance() >= found ? 1 : 0;
  } while (std::next_permutation(moving.begin(), moving.end()));
  return static_cast<double>(as_strong) / static_cast<double>(all);
}

// P(S >= s) for S = sum of squared differences of the ranks, by the Edgeworth series of AS 89.
double upper_tail_of_squares(double s, double n) {
  const double b = 1.0 / n;
  const double x = (6.0 * (s - 1.0) * b / (n * n - 1.0) - 1.0) * std::sqrt(n - 1.0);
  const double y = x * x;
  const double u =
      x * b *
      (0.2274 + b * (0.2531 + 0.1745 * b) +
       y * (-0.0758 + b * (0.1033 + 0.3932 * b) -
            y * b *
                (0.0879 + 0.0151 * b - y * (0.0072 - 0.0831 * b + y * b * (0.0131 - 4.6e-4 * y)))));
  return std::clamp(u / std::exp(0.5 * y) + normal_upper_tail(x), 0.0, 1.0);
}

// S takes even values only; the tails are P(S <= s) = 1 - P(S >= s + 2) and P(S >= s).
double p_of_series(double rho, double n) {
  const double middle = n * (n * n - 1.0) / 6.0;
  const double s = 2.0 * std::round(0.5 * middle * (1.0 - rho));
  const double tail =
      s > middle ? upper_tail_of_squares(s, n) : 1.0 - upper_tail_of_squares(s + 2.0, n);
  return std::min(1.0, 2.0 * tail);
}

void check_lengths(std::span<const double> a, std::span<const double> b) {
  if (a.size() != b.size()) {
    throw std::invalid_argument("correlation: the variables differ in length");
  }
}

}  // namespace

Defined<Correlation> pearson_correlation(std::span<const double> a, std::span<const double> b,
                                         double level) {
  check_lengths(a, b);
  const auto r = pearson_r(a, b);
  if (!r) {
    return Undefined{r.because()};
  }
  const auto n = static_cast<double>(a.size());
  return Correlation{*r, p_of_t(*r, n), a.size(), fisher(*r, n, 1.0, level)};
}

Defined<Correlation> spearman_correlation(std::span<const double> a, std::span<const double> b,
                                          double level) {
  check_lengths(a, b);
  if (const auto finite = pearson_r(a, b); !finite) {
    return Undefined{finite.because()};
  }
  const Ranks ra = *midranks(a);
  const Ranks rb = *midranks(b);
  const double r = *pearson_r(ra.ranks, rb.ranks);
  const auto n = static_cast<double>(a.size());
  constexpr std::size_t kArrangements = 9;  // pairs: 362880 of them
  double p = 0.0;
  if (a.size() <= kArrangements) {
    p = p_of_arrangements(ra.ranks, rb.ranks);
  } else {
    p = ra.ties + rb.ties > 0.0 ? p_of_t(r, n) : p_of_series(r, n);
  }
  return Correlation{r, p, a.size(), fisher(r, n, 1.0 + 0.5 * r * r, level)};
}

Coefficient coefficient(double estimate, double error, double df, double level) {
  const double t = estimate / error;
  const double half = t_quantile(0.5 * (1.0 + level), df) * error;
  const double p = std::min(1.0, 2.0 * t_upper_tail(std::abs(t), df));
  return {estimate, error, df, t, p, estimate - half, estimate + half};
}

}  // namespace haptrial::analysis
