#include "analysis/statistics/tests/repeated_power.h"

#include <string>
#include <utility>

#include "analysis/statistics/tests/power_curve.h"

namespace haptrial::analysis {
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
