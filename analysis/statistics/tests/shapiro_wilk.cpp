#include "analysis/statistics/tests/shapiro_wilk.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <numbers>
#include <vector>

#include "analysis/statistics/base/descriptive.h"
#include "analysis/statistics/base/distributions.h"

namespace haptrial::analysis {
namespace {

// Coefficients in rising powers.
double polynomial(std::initializer_list<double> coefficients, double x) {
  double result = 0.0;
  for (auto c = std::rbegin(coefficients); c != std::rend(coefficients); ++c) {
    result = result * x + *c;
  }
  return result;
}

// The weights of the upper half, largest first; those of the lower half are their negatives.
// Royston approximates the two largest and scales the expected normal order statistics for the rest
// so that all squares add up to 1.
std::vector<double> weights(std::size_t n) {
  if (n == 3) {
    return {std::numbers::sqrt2 / 2.0};
  }
  const auto count = static_cast<double>(n);
  std::vector<double> expected(n / 2);
  double squares = 0.0;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    expected[i] = -normal_quantile((static_cast<double>(i) + 0.625) / (count + 0.25));
    squares += 2.0 * expected[i] * expected[i];
  }
  const double u = 1.0 / std::sqrt(count);
  std::vector<double> result = expected;
  result[0] = expected[0] / std::sqrt(squares) +
              polynomial({0.0, 0.221157, -0.147981, -2.07119, 4.434685, -2.706056}, u);
  std::size_t approximated = 1;
  if (n > 5) {
    result[1] = expected[1] / std::sqrt(squares) +
                polynomial({0.0, 0.042981, -0.293762, -1.752461, 5.682633, -3.582633}, u);
    approximated = 2;
  }
  double left = 1.0;  // of the squares, for the others
  for (std::size_t i = 0; i < approximated; ++i) {
    squares -= 2.0 * expected[i] * expected[i];
    left -= 2.0 * result[i] * result[i];
  }
  for (std::size_t i = approximated; i < result.size(); ++i) {
    result[i] = expected[i] * std::sqrt(left / squares);
  }
  return result;
}

// @param rest  1 - W.
double p_value(double rest, std::size_t n) {
  const auto count = static_cast<double>(n);
  if (n == 3) {  // exact: W is at least 3/4
    const double angle = std::asin(std::sqrt(1.0 - rest)) - std::asin(std::sqrt(0.75));
    return std::clamp(6.0 / std::numbers::pi * angle, 0.0, 1.0);
  }
  double y = std::log(rest);
  double mean = 0.0;
  double deviation = 0.0;
  if (n <= 11) {
    const double gamma = polynomial({-2.273, 0.459}, count);
    y = -std::log(gamma - y);  // gamma > y: W is at least n a1^2 / (n - 1)
    mean = polynomial({0.544, -0.39978, 0.025054, -6.714e-4}, count);
    deviation = std::exp(polynomial({1.3822, -0.77857, 0.062767, -0.0020322}, count));
  } else {
    const double size = std::log(count);
    mean = polynomial({-1.5861, -0.31082, -0.083751, 0.0038915}, size);
    deviation = std::exp(polynomial({-0.4803, -0.082676, 0.0030302}, size));
  }
  return normal_upper_tail((y - mean) / deviation);
}

}  // namespace

Defined<ShapiroWilk> shapiro_wilk(std::span<const double> values) {
  const auto m = moments(values);
  if (!m) {
    return Undefined{m.because()};
  }
  if (values.size() < 3 || values.size() > 5000) {
    return Undefined{values.size() < 3 ? "there are fewer than three values"
                                       : "there are more than 5000 values"};
  }
  if (m->squares == 0.0) {
    return Undefined{"all values are equal"};
  }
  std::vector<double> sorted(values.begin(), values.end());
  std::sort(sorted.begin(), sorted.end());
  const std::vector<double> a = weights(sorted.size());
  double slope = 0.0;  // of the values on the weights, whose squares add up to 1
  for (std::size_t i = 0; i < a.size(); ++i) {
    slope += a[i] * (sorted[sorted.size() - 1 - i] - sorted[i]);
  }
  // 1 - W from what the line leaves: W itself would lose the digits of a good fit.
  double left = 0.0;
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    const std::size_t mirrored = sorted.size() - 1 - i;
    const double weight = i < a.size() ? -a[i] : mirrored < a.size() ? a[mirrored] : 0.0;
    const double residual = (sorted[i] - m->origin) - m->offset - slope * weight;
    left += residual * residual;
  }
  const double rest = left / m->squares;
  return ShapiroWilk{1.0 - rest, p_value(rest, sorted.size())};
}

}  // namespace haptrial::analysis
