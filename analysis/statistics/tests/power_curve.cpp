#include "analysis/statistics/tests/power_curve.h"

#include <algorithm>
#include <cmath>

#include "analysis/statistics/base/noncentral.h"
#include "analysis/statistics/base/root.h"

namespace haptrial::analysis {
namespace {

constexpr double kMost = 1e7;  // participants

// Place at which a rising curve reaches the power; above `most`, nothing.
Defined<double> reached(const PowerCurve& curve, double power, double low, double most,
                        const char* sentence) {
  double high = 2.0 * low;
  while (curve(high) < power) {
    if (high >= most) {
      return Undefined{sentence};
    }
    low = high;
    high = std::min(most, 2.0 * high);
  }
  return find_root([&](double x) { return curve(x) - power; }, low, high);
}

double f_critical(double probability, double df_numerator, double df_denominator) {
  const auto tail = [&](double f) {
    return noncentral_f(f, df_numerator, df_denominator, 0.0).upper - probability;
  };
  double high = 2.0;
  while (tail(high) > 0.0) {
    high *= 2.0;
  }
  return find_root(tail, 0.0, high);
}

}  // namespace

double f_power(double alpha, double df_numerator, double df_denominator, double lambda) {
  return noncentral_f(f_critical(alpha, df_numerator, df_denominator), df_numerator, df_denominator,
                      lambda)
      .upper;
}

Defined<SampleSize> size_reaching(const PowerCurve& curve, double power, double smallest) {
  if (const double least = curve(smallest); least >= power) {
    return SampleSize{smallest, static_cast<long>(smallest), least};
  }
  const auto exact =
      reached(curve, power, smallest, kMost, "more than ten million participants would be needed");
  if (!exact) {
    return Undefined{exact.because()};
  }
  const auto n = static_cast<long>(std::ceil(*exact - 1e-9));
  return SampleSize{*exact, n, curve(static_cast<double>(n))};
}

Defined<double> effect_reaching(const PowerCurve& curve, double power) {
  constexpr double kSmall = 1e-9;
  return reached(curve, power, kSmall, 100.0,
                 "an effect of more than 100 standard deviations would be needed");
}

std::string problem_of_plan(double alpha, double n, double effect) {
  if (!(alpha > 0.0 && alpha < 1.0)) {
    return "alpha is not between 0 and 1";
  }
  if (!(n > 1.0 && n <= kMost)) {
    return "the number of participants is not between 2 and ten million";
  }
  constexpr double kLargestEffect = 100.0;
  if (!(std::abs(effect) <= kLargestEffect)) {
    return "the effect is above 100 standard deviations";
  }
  return {};
}

std::string problem_of_power(double alpha, double power) {
  return power > alpha && power < 1.0 ? "" : "the power asked for is not between alpha and 1";
}

}  // namespace haptrial::analysis
