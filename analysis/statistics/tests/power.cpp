#include "analysis/statistics/tests/power.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <utility>

#include "analysis/statistics/base/noncentral.h"
#include "analysis/statistics/base/solvers.h"

namespace haptrial::analysis {
namespace {

/// Power over a size or an effect; rises.
using PowerCurve = std::function<double(double)>;

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

/// The share of the noncentral F that lies beyond the critical value of the central one.
/// @param alpha  above 0 and below 1; both df above 0; lambda >= 0
double f_power(double alpha, double df_numerator, double df_denominator, double lambda) {
  return noncentral_f(f_critical(alpha, df_numerator, df_denominator), df_numerator, df_denominator,
                      lambda)
      .upper;
}

/// The first size, at least the smallest, at which the curve reaches the power.
/// Undefined where ten million participants would not do.
Defined<SampleSize> size_reaching(const PowerCurve& curve, double power, double smallest = 2.0) {
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

/// The effect likewise. Undefined above 100 standard deviations.
Defined<double> effect_reaching(const PowerCurve& curve, double power) {
  constexpr double kSmall = 1e-9;
  return reached(curve, power, kSmall, 100.0,
                 "an effect of more than 100 standard deviations would be needed");
}

/// Fault of a plan, as a part of a sentence; empty: none.
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

double t_df(const TPlan& plan, double n) {
  return plan.design == TDesign::kTwoSample ? n * (1.0 + plan.ratio) - 2.0 : n - 1.0;
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

double t_curve(const TPlan& plan, double n, double delta) {
  const double df = t_df(plan, n);
  const double cases = plan.design == TDesign::kTwoSample ? n * plan.ratio / (1.0 + plan.ratio) : n;
  const double noncentrality = delta * std::sqrt(cases);
  const double critical = t_critical(plan.one_tailed ? plan.alpha : 0.5 * plan.alpha, df);
  const double power = noncentral_t(critical, df, noncentrality).upper;
  return plan.one_tailed ? power
                         : std::min(1.0, power + noncentral_t(-critical, df, noncentrality).lower);
}

double anova_curve(const AnovaPlan& plan, double n, double f) {
  const double groups = plan.groups;
  const double df_between = groups - 1.0;
  const double df_within = groups * (n - 1.0);
  return f_power(plan.alpha, df_between, df_within, groups * n * f * f);
}

}  // namespace

Defined<double> t_power(const TPlan& plan, double n, double delta) {
  if (auto why = problem_of_plan(plan.alpha, n, delta); !why.empty()) {
    return Undefined{std::move(why)};
  }
  return t_curve(plan, n, delta);
}

Defined<double> anova_power(const AnovaPlan& plan, double n, double f) {
  if (auto why = problem_of_plan(plan.alpha, n, f); !why.empty()) {
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

namespace {

constexpr int kMostCells = 1000;  // groups, or measurements

double curve_at(const RepeatedPlan& plan, double n, double f) {
  const double k = plan.groups;
  const double m = plan.measurements;
  const double all = k * n;
  const double square = all * m * f * f;
  if (plan.term == RepeatedTerm::kBetween) {
    return f_power(plan.alpha, k - 1.0, all - k, square / (1.0 + (m - 1.0) * plan.correlation));
  }
  const double of_groups = plan.term == RepeatedTerm::kInteraction ? k - 1.0 : 1.0;
  return f_power(plan.alpha, plan.epsilon * of_groups * (m - 1.0),
                 plan.epsilon * (all - k) * (m - 1.0),
                 plan.epsilon * square / (1.0 - plan.correlation));
}

std::string problem_of(const RepeatedPlan& plan) {
  const int fewest = plan.term == RepeatedTerm::kWithin ? 1 : 2;
  if (plan.groups < fewest || plan.groups > kMostCells) {
    return fewest == 1 ? "the number of groups is not between 1 and 1000"
                       : "the number of groups is not between 2 and 1000";
  }
  if (plan.measurements < 2 || plan.measurements > kMostCells) {
    return "the number of measurements is not between 2 and 1000";
  }
  if (!(plan.correlation >= 0.0 && plan.correlation < 1.0)) {
    return "the correlation is not at least 0 and below 1";
  }
  constexpr double kRounding = 1e-9;
  if (!(plan.epsilon >= 1.0 / (plan.measurements - 1.0) - kRounding && plan.epsilon <= 1.0)) {
    return "epsilon is not between 1 / (measurements - 1) and 1";
  }
  return {};
}

std::string problem_of(const RepeatedPlan& plan, double n, double f) {
  if (auto why = problem_of(plan); !why.empty()) {
    return why;
  }
  return f < 0.0 ? "f is below 0" : problem_of_plan(plan.alpha, n, f);
}

}  // namespace

Defined<double> repeated_power(const RepeatedPlan& plan, double n, double f) {
  if (auto why = problem_of(plan, n, f); !why.empty()) {
    return Undefined{std::move(why)};
  }
  return curve_at(plan, n, f);
}

Defined<SampleSize> repeated_sample_size(const RepeatedPlan& plan, double f, double power) {
  auto why = problem_of(plan, 2.0, f);
  why = why.empty() ? problem_of_power(plan.alpha, power) : why;
  why = why.empty() && f == 0.0 ? "there is no effect to find" : why;
  if (!why.empty()) {
    return Undefined{std::move(why)};
  }
  return size_reaching([&](double n) { return curve_at(plan, n, f); }, power);
}

Defined<double> repeated_detectable(const RepeatedPlan& plan, double n, double power) {
  auto why = problem_of(plan, n, 1.0);
  why = why.empty() ? problem_of_power(plan.alpha, power) : why;
  if (!why.empty()) {
    return Undefined{std::move(why)};
  }
  return effect_reaching([&](double f) { return curve_at(plan, n, f); }, power);
}

}  // namespace haptrial::analysis
