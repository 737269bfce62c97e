#include "analysis/statistics/tests/power.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

#include "analysis/statistics/base/noncentral.h"
#include "analysis/statistics/base/root.h"

namespace haptrial::analysis {
namespace {

constexpr double kMost = 1e7;  // participants

using Curve = std::function<double(double)>;  // power over a size or an effect; rises

// Where a rising curve reaches the power; above `most`, nothing.
Defined<double> reached(const Curve& curve, double power, double low, double most,
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

double t_df(const TPlan& plan, double n) {
  return plan.design == TDesign::kTwoSample ? 2.0 * (n - 1.0) : n - 1.0;
}

// The t that the central distribution exceeds with this probability.
double t_critical(double probability, double df) {
  const auto tail = [&](double t) { return noncentral_t(t, df, 0.0).upper - probability; };
  double high = 2.0;
  while (tail(high) > 0.0) {
    high *= 2.0;
  }
  return find_root(tail, 0.0, high);
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

double t_curve(const TPlan& plan, double n, double delta) {
  const double df = t_df(plan, n);
  const double noncentrality = delta * std::sqrt(plan.design == TDesign::kTwoSample ? 0.5 * n : n);
  const double critical = t_critical(plan.one_tailed ? plan.alpha : 0.5 * plan.alpha, df);
  const double power = noncentral_t(critical, df, noncentrality).upper;
  return plan.one_tailed ? power
                         : std::min(1.0, power + noncentral_t(-critical, df, noncentrality).lower);
}

double anova_curve(const AnovaPlan& plan, double n, double f) {
  const double groups = plan.groups;
  const double df_between = groups - 1.0;
  const double df_within = groups * (n - 1.0);
  return noncentral_f(f_critical(plan.alpha, df_between, df_within), df_between, df_within,
                      groups * n * f * f)
      .upper;
}

// Empty when the plan can be computed.
std::string problem(double alpha, double n, double effect) {
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

// From the smallest size at which the test exists.
Defined<SampleSize> size_reaching(const Curve& curve, double power) {
  constexpr double kSmallest = 2.0;
  if (const double least = curve(kSmallest); least >= power) {
    return SampleSize{kSmallest, static_cast<long>(kSmallest), least};
  }
  const auto exact =
      reached(curve, power, kSmallest, kMost, "more than ten million participants would be needed");
  if (!exact) {
    return Undefined{exact.because()};
  }
  const auto n = static_cast<long>(std::ceil(*exact - 1e-9));
  return SampleSize{*exact, n, curve(static_cast<double>(n))};
}

Defined<double> effect_reaching(const Curve& curve, double power) {
  constexpr double kSmall = 1e-9;
  return reached(curve, power, kSmall, 100.0,
                 "an effect of more than 100 standard deviations would be needed");
}

}  // namespace

Defined<double> t_power(const TPlan& plan, double n, double delta) {
  if (auto why = problem(plan.alpha, n, delta); !why.empty()) {
    return Undefined{std::move(why)};
  }
  return t_curve(plan, n, delta);
}

Defined<double> anova_power(const AnovaPlan& plan, double n, double f) {
  if (auto why = problem(plan.alpha, n, f); !why.empty()) {
    return Undefined{std::move(why)};
  }
  if (plan.groups < 2 || f < 0.0) {
    return Undefined{plan.groups < 2 ? "there are fewer than two groups" : "f is below 0"};
  }
  return anova_curve(plan, n, f);
}

Defined<SampleSize> t_sample_size(const TPlan& plan, double delta, double power) {
  if (const auto any = t_power(plan, 2.0, delta); !any) {
    return Undefined{any.because()};
  }
  if (auto why = problem_of_power(plan.alpha, power); !why.empty()) {
    return Undefined{std::move(why)};
  }
  if (delta == 0.0 || (plan.one_tailed && delta < 0.0)) {
    return Undefined{"there is no effect to find"};
  }
  return size_reaching([&](double n) { return t_curve(plan, n, delta); }, power);
}

Defined<SampleSize> anova_sample_size(const AnovaPlan& plan, double f, double power) {
  if (const auto any = anova_power(plan, 2.0, f); !any) {
    return Undefined{any.because()};
  }
  if (auto why = problem_of_power(plan.alpha, power); !why.empty()) {
    return Undefined{std::move(why)};
  }
  if (f == 0.0) {
    return Undefined{"there is no effect to find"};
  }
  return size_reaching([&](double n) { return anova_curve(plan, n, f); }, power);
}

Defined<double> t_detectable(const TPlan& plan, double n, double power) {
  if (const auto any = t_power(plan, n, 1.0); !any) {
    return Undefined{any.because()};
  }
  if (auto why = problem_of_power(plan.alpha, power); !why.empty()) {
    return Undefined{std::move(why)};
  }
  return effect_reaching([&](double delta) { return t_curve(plan, n, delta); }, power);
}

Defined<double> anova_detectable(const AnovaPlan& plan, double n, double power) {
  if (const auto any = anova_power(plan, n, 1.0); !any) {
    return Undefined{any.because()};
  }
  if (auto why = problem_of_power(plan.alpha, power); !why.empty()) {
    return Undefined{std::move(why)};
  }
  return effect_reaching([&](double f) { return anova_curve(plan, n, f); }, power);
}

}  // namespace haptrial::analysis
