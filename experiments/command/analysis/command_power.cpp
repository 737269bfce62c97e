#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "analysis/statistics/tests/power.h"
#include "core/base/error.h"
#include "core/base/nearest.h"
#include "experiments/command/subcommand.h"

namespace haptrial::experiments {
namespace {

struct PowerOptions {
  std::string test;
  std::optional<std::string> design;
  std::optional<double> delta;
  double sd{1.0};
  std::optional<double> f;
  std::optional<int> groups;
  std::optional<std::string> effect;
  std::optional<int> measurements;
  std::optional<double> correlation;
  std::optional<double> epsilon;
  std::optional<long> n;
  std::optional<double> power;
  double alpha{0.05};
  bool one_tailed{false};
};

constexpr int kMostGroups = 1000;
constexpr const char* kDefaultDesign = "two-sample";
constexpr const char* kDefaultEffect = "within";

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
  if (options.test != "t") {
    return options.f;
  }
  return options.delta ? std::optional(std::abs(*options.delta) / options.sd) : std::nullopt;
}

/// An option, whether it was given, and the tests that it belongs to.
struct OptionScope {
  const char* option;
  bool given;
  std::vector<std::string> tests;
};

void check_test(const PowerOptions& o) {
  const std::vector<std::string> tests{"t", "anova", "repeated"};
  if (o.test.empty()) {
    throw InputError("TEST is missing; allowed: t, anova, repeated, or one of the subcommands");
  }
  if (std::ranges::find(tests, o.test) == tests.end()) {
    throw InputError(not_allowed("TEST", fmt::format("'{}'", o.test), tests));
  }
  for (const OptionScope& each : {OptionScope{"--f", o.f.has_value(), {"anova", "repeated"}},
                                  {"--groups", o.groups.has_value(), {"anova", "repeated"}},
                                  {"--delta", o.delta.has_value(), {"t"}},
                                  {"--design", o.design.has_value(), {"t"}},
                                  {"--one-tailed", o.one_tailed, {"t"}},
                                  {"--effect", o.effect.has_value(), {"repeated"}},
                                  {"--measurements", o.measurements.has_value(), {"repeated"}},
                                  {"--correlation", o.correlation.has_value(), {"repeated"}},
                                  {"--epsilon", o.epsilon.has_value(), {"repeated"}}}) {
    if (each.given && std::ranges::find(each.tests, o.test) == each.tests.end()) {
      throw InputError(fmt::format("{} is given with {}; use it with {} only", each.option, o.test,
                                   fmt::join(each.tests, " or ")));
    }
  }
  if (o.test == "anova" && !o.groups) {
    throw InputError("--groups is missing; give the number of groups");
  }
  if (o.test == "repeated" && !o.measurements) {
    throw InputError("--measurements is missing; give the number of conditions that everybody has");
  }
}

void check_count(const char* option, const std::optional<int>& count, int fewest) {
  if (count && (*count < fewest || *count > kMostGroups)) {
    throw InputError(fmt::format("{} is {}; allowed: a whole number from {} to {}", option, *count,
                                 fewest, kMostGroups));
  }
}

void check_numbers(const PowerOptions& options) {
  check_inside("--alpha", options.alpha, 0.0, 1.0);
  check_inside("--sd", options.sd, 0.0, INFINITY);
  if (options.power) {
    check_inside("--power", *options.power, options.alpha, 1.0);
  }
  const int fewest =
      options.test == "repeated" && options.effect.value_or(kDefaultEffect) == "within" ? 1 : 2;
  check_count("--groups", options.groups, fewest);
  check_count("--measurements", options.measurements, 2);
  if (const double r = options.correlation.value_or(0.0); !(r >= 0.0 && r < 1.0)) {
    throw InputError(fmt::format("--correlation is {}; allowed: a number from 0 to below 1", r));
  }
  if (options.epsilon) {
    const double least = 1.0 / (*options.measurements - 1.0);
    if (!(*options.epsilon >= least - 1e-9 && *options.epsilon <= 1.0)) {
      throw InputError(fmt::format(
          "--epsilon is {}; allowed: a number from 1 / (measurements - 1) = {:.4g} to 1",
          *options.epsilon, least));
    }
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
                                 options.test == "t" ? "--delta" : "--f"));
  }
}

analysis::TPlan t_plan(const PowerOptions& options) {
  const std::string design = options.design.value_or(kDefaultDesign);
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

/// Plan once the third of effect, size and power is computed.
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

analysis::RepeatedPlan repeated_plan(const PowerOptions& options) {
  analysis::RepeatedPlan plan;
  const std::string effect = options.effect.value_or(kDefaultEffect);
  if (effect != "within" && effect != "interaction" && effect != "between") {
    throw InputError(
        not_allowed("--effect", fmt::format("'{}'", effect), {"within", "interaction", "between"}));
  }
  plan.term = effect == "within"    ? analysis::RepeatedTerm::kWithin
              : effect == "between" ? analysis::RepeatedTerm::kBetween
                                    : analysis::RepeatedTerm::kInteraction;
  plan.groups = options.groups.value_or(plan.term == analysis::RepeatedTerm::kWithin ? 1 : 2);
  plan.measurements = *options.measurements;
  plan.correlation = options.correlation.value_or(plan.correlation);
  plan.epsilon = options.epsilon.value_or(plan.epsilon);
  plan.alpha = options.alpha;
  return plan;
}

Plan repeated_solution(const PowerOptions& options, const analysis::RepeatedPlan& plan) {
  if (!options.n) {
    const auto size = value_of(analysis::repeated_sample_size(plan, *options.f, *options.power));
    return {*options.f, size.n, size.power};
  }
  const auto n = static_cast<double>(*options.n);
  if (!options.power) {
    return {*options.f, *options.n, value_of(analysis::repeated_power(plan, n, *options.f))};
  }
  return {value_of(analysis::repeated_detectable(plan, n, *options.power)), *options.n,
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
  const std::string design = options.design.value_or(kDefaultDesign);
  fmt::print("{} t test, {}-tailed, significance level {}\n", design,
             options.one_tailed ? "one" : "two", options.alpha);
  const double delta = options.delta.value_or(plan.effect * options.sd);
  const std::string effect = fmt::format("{:.4g}", std::copysign(plan.effect, delta));
  fmt::print("difference    {:.6g}, {} standard deviation{}{}\n", delta, effect,
             effect == "1" || effect == "-1" ? "" : "s",
             design == "paired" ? " of the differences" : "");
  print_size(plan, design == "two-sample" ? 2 : 1);
}

void print_repeated(const PowerOptions& options) {
  const analysis::RepeatedPlan plan = repeated_plan(options);
  const Plan solution = repeated_solution(options, plan);
  fmt::print("{}, {} group{}, {} measurements, correlation {}, epsilon {}, significance level {}\n",
             plan.term == analysis::RepeatedTerm::kWithin ? "within participants"
             : plan.term == analysis::RepeatedTerm::kBetween
                 ? "between groups"
                 : "interaction of groups and measurements",
             plan.groups, plan.groups == 1 ? "" : "s", plan.measurements, plan.correlation,
             plan.epsilon, plan.alpha);
  fmt::print("effect        f = {:.4g}: standard deviation of the means over that within a cell\n",
             solution.effect);
  print_size(solution, plan.groups);
}

int power(const PowerOptions& options) {
  check_test(options);
  check_numbers(options);
  if (options.test == "t") {
    print_t(options, t_solution(options));
    return 0;
  }
  if (options.test == "repeated") {
    print_repeated(options);
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

}  // namespace

void add_power(CLI::App& app, int& status) {
  CLI::App* sub = subcommand(app, "power",
                             "Compute the participants, the effect or the power of a planned study",
                             "haptrial power t --design paired --delta 20 --sd 35 --power 0.8",
                             {"", "algorithms/power.md"});
  auto& o = options_of<PowerOptions>(*sub, status, [sub, &status](const PowerOptions& options) {
    return sub->get_subcommands().empty() ? power(options) : status;
  });
  sub->add_option("TEST", o.test,
                  "Test: t, anova (one-way) or repeated (repeated measures and mixed designs)");
  sub->add_option(
      "--design", o.design,
      with_default("Design of the t test: two-sample, paired or one-sample", kDefaultDesign));
  sub->add_option("--delta", o.delta, "Difference of the means to detect (t test)");
  sub->add_option(
      "--sd", o.sd,
      with_default("Standard deviation, of the differences if paired, in the unit of --delta",
                   o.sd));
  sub->add_option(
      "--f", o.f,
      "Effect size f: standard deviation of the means over that within a cell (anova, repeated)");
  sub->add_option("--groups", o.groups, "Number of groups (anova; repeated, default: 1)");
  sub->add_option("--effect", o.effect,
                  fmt::format("Effect: within, interaction or between (repeated; default: {})",
                              kDefaultEffect));
  sub->add_option("--measurements", o.measurements,
                  "Number of conditions that everybody has (repeated)");
  sub->add_option(
      "--correlation", o.correlation,
      fmt::format("Correlation of any two conditions over participants (repeated; default: {})",
                  analysis::RepeatedPlan{}.correlation));
  sub->add_option(
      "--epsilon", o.epsilon,
      fmt::format("Epsilon of Greenhouse and Geisser, 1 for a sphere (repeated; default: {})",
                  analysis::RepeatedPlan{}.epsilon));
  sub->add_option("--n", o.n, "Number of participants in each group");
  sub->add_option("--power", o.power, "Power: probability of detecting the effect");
  sub->add_option("--alpha", o.alpha,
                  with_default("Significance level: false-positive rate", o.alpha));
  sub->add_flag("--one-tailed", o.one_tailed,
                "Test one tail only; the sign of the difference was planned (t test)");
  add_power_simulate(*sub, status);
  add_power_merge(*sub, status);
  add_power_status(*sub, status);
  add_power_plan(*sub, status);
}

}  // namespace haptrial::experiments
