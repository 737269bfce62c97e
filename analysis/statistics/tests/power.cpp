#include "analysis/statistics/tests/power.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "analysis/statistics/base/noncentral.h"
#include "analysis/statistics/base/root.h"
#include "analysis/statistics/tests/power_curve.h"

namespace haptrial::analysis {
namespace {

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

}  // namespace haptrial::analysis
