#include <fmt/format.h>

#include <cmath>
#include <string>
#include <tuple>

#include "analysis/statistics/tests/power.h"
#include "core/base/error.h"
#include "core/base/text/nearest.h"
#include "experiments/command/commands.h"

namespace haptrial::experiments {
namespace {

constexpr int kMostGroups = 1000;

void check_inside(const char* option, double value, double low, double high) {
  if (!(value > low && value < high)) {
    const std::string allowed = std::isinf(high)
                                    ? fmt::format("a number above {}", low)
                                    : fmt::format("a number between {} and {}", low, high);
    throw InputError(fmt::format("{} is {}; allowed: {}", option, value, allowed));
  }
}

/// The effect in standard deviations: |delta| / sd, or f. A one-tailed test looks where delta
/// points.
std::optional<double> effect_of(const PowerOptions& options) {
  if (options.test == "anova") {
    return options.f;
  }
  return options.delta ? std::optional(std::abs(*options.delta) / options.sd) : std::nullopt;
}

void check_test(const PowerOptions& options) {
  const bool anova = options.test == "anova";
  if (!anova && options.test != "t") {
    throw InputError(not_allowed("TEST", fmt::format("'{}'", options.test), {"t", "anova"}));
  }
  for (const auto& [option, given, belongs, test] :
       {std::tuple{"--f", options.f.has_value(), anova, "anova"},
        {"--groups", options.groups.has_value(), anova, "anova"},
        {"--delta", options.delta.has_value(), !anova, "t"},
        {"--design", options.design.has_value(), !anova, "t"},
        {"--one-tailed", options.one_tailed, !anova, "t"}}) {
    if (given && !belongs) {
      throw InputError(
          fmt::format("{} is given with {}; use it with {} only", option, options.test, test));
    }
  }
  if (anova && !options.groups) {
    throw InputError("--groups is missing; give the number of groups");
  }
}

void check_numbers(const PowerOptions& options) {
  check_inside("--alpha", options.alpha, 0.0, 1.0);
  check_inside("--sd", options.sd, 0.0, INFINITY);
  if (options.power) {
    check_inside("--power", *options.power, options.alpha, 1.0);
  }
  if (options.groups && (*options.groups < 2 || *options.groups > kMostGroups)) {
    throw InputError(fmt::format("--groups is {}; allowed: a whole number from 2 to {}",
                                 *options.groups, kMostGroups));
  }
  if (options.n && *options.n < 2) {
    throw InputError(fmt::format("--n is {}; allowed: a whole number of at least 2", *options.n));
  }
  if (options.f) {
    check_inside("--f", *options.f, 0.0, INFINITY);
  }
  if (options.delta && (*options.delta == 0.0 || !std::isfinite(*options.delta))) {
    throw InputError(fmt::format("--delta is {}; allowed: a number other than 0", *options.delta));
  }
  const int given = (effect_of(options) ? 1 : 0) + (options.n ? 1 : 0) + (options.power ? 1 : 0);
  if (given != 2) {
    throw InputError(fmt::format("give two of {}, --n and --power; the third is computed",
                                 options.test == "anova" ? "--f" : "--delta"));
  }
}

analysis::TPlan t_plan(const PowerOptions& options) {
  const std::string design = options.design.value_or("two-sample");
  analysis::TPlan plan{analysis::TDesign::kTwoSample, options.alpha, options.one_tailed};
  if (design == "one-sample") {
    plan.design = analysis::TDesign::kOneSample;
  } else if (design == "paired") {
    plan.design = analysis::TDesign::kPaired;
  } else if (design != "two-sample") {
    throw InputError(not_allowed("--design", fmt::format("'{}'", design),
                                 {"two-sample", "paired", "one-sample"}));
  }
  return plan;
}

template <class T>
T value_of(const analysis::Defined<T>& result) {
  if (!result) {
    throw InputError(
        fmt::format("power: {}; choose another effect, --n or --power", result.because()));
  }
  return *result;
}

/// What is known once the third of effect, size and power is computed.
struct Plan {
  double effect{0.0};
  long n{0};
  double power{0.0};
};

Plan t_solution(const PowerOptions& options) {
  const analysis::TPlan plan = t_plan(options);
  const auto effect = effect_of(options);
  if (!options.n) {
    const auto size = value_of(analysis::t_sample_size(plan, *effect, *options.power));
    return {*effect, size.n, size.power};
  }
  const auto n = static_cast<double>(*options.n);
  if (!options.power) {
    return {*effect, *options.n, value_of(analysis::t_power(plan, n, *effect))};
  }
  return {value_of(analysis::t_detectable(plan, n, *options.power)), *options.n, *options.power};
}

Plan anova_solution(const PowerOptions& options) {
  const analysis::AnovaPlan plan{*options.groups, options.alpha};
  if (!options.n) {
    const auto size = value_of(analysis::anova_sample_size(plan, *options.f, *options.power));
    return {*options.f, size.n, size.power};
  }
  const auto n = static_cast<double>(*options.n);
  if (!options.power) {
    return {*options.f, *options.n, value_of(analysis::anova_power(plan, n, *options.f))};
  }
  return {value_of(analysis::anova_detectable(plan, n, *options.power)), *options.n,
          *options.power};
}

void print_size(const Plan& plan, int groups) {
  if (groups == 1) {
    fmt::print("participants  {}\n", plan.n);
  } else {
    fmt::print("participants  {} in each of {} groups, {} in all\n", plan.n, groups,
               plan.n * groups);
  }
  fmt::print("power         {:.4f}\n", plan.power);
}

void print_t(const PowerOptions& options, const Plan& plan) {
  const std::string design = options.design.value_or("two-sample");
  fmt::print("{} t test, {}-tailed, significance level {}\n", design,
             options.one_tailed ? "one" : "two", options.alpha);
  const double delta = options.delta.value_or(plan.effect * options.sd);
  const std::string effect = fmt::format("{:.4g}", std::copysign(plan.effect, delta));
  fmt::print("difference    {:.6g}, {} standard deviation{}{}\n", delta, effect,
             effect == "1" || effect == "-1" ? "" : "s",
             design == "paired" ? " of the differences" : "");
  print_size(plan, design == "two-sample" ? 2 : 1);
}

}  // namespace

int power(const PowerOptions& options) {
  check_test(options);
  check_numbers(options);
  if (options.test == "t") {
    print_t(options, t_solution(options));
    return 0;
  }
  const Plan plan = anova_solution(options);
  fmt::print("one-way analysis of variance, {} groups, significance level {}\n", *options.groups,
             options.alpha);
  fmt::print(
      "effect        f = {:.4g}: standard deviation of the group means over that within groups\n",
      plan.effect);
  print_size(plan, *options.groups);
  return 0;
}

}  // namespace haptrial::experiments
