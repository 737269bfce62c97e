#include "core/deformable/calibration/descent.h"

#include <nlopt.h>

#include <array>
#include <exception>
#include <memory>

#include "core/deformable/calibration/global_start.h"

namespace haptrial::deformable {
namespace {

constexpr std::size_t kEven = kSpringKinds.size();

std::size_t kind_of(const SpringParameters& parameters, std::size_t parameter) {
  return parameter < parameters.first(SpringKind::kArea)     ? 0
         : parameter < parameters.first(SpringKind::kVolume) ? 1
                                                             : 2;
}

/// Weight and gradient of the prior towards even constants.
class EvenPrior {
 public:
  EvenPrior(const SpringParameters& parameters, double weight)
      : parameters_(parameters), weight_(weight) {}

  /// Adds the prior's slope. @returns its value [m]
  double add(std::span<const double> x, std::span<double> slope) const {
    std::array<double, kEven> sum{}, count{};
    for (std::size_t i = 0; i < x.size(); ++i) {
      sum[kind_of(parameters_, i)] += x[i];
      count[kind_of(parameters_, i)] += 1.0;
    }
    double value = 0.0;
    const double each = weight_ / static_cast<double>(x.size());
    for (std::size_t i = 0; i < x.size(); ++i) {
      const std::size_t kind = kind_of(parameters_, i);
      const double uneven = x[i] - sum[kind] / count[kind];
      value += each * uneven * uneven;
      slope[i] += 2.0 * each * uneven;
    }
    return value;
  }

 private:
  const SpringParameters& parameters_;
  double weight_;
};

/// A stage of the descent: the point x that is searched says all parameters' logarithms.
struct Stage {
  bool even{false};    // x is three numbers, one for each kind
  double prior{0.0};   // weight of the prior [m]
  long evaluations{};  // at most
  long patience{};     // evaluations without better held-out loads; 0: all
};

/// Context of NLopt's callback.
struct DescentCall {
  const CalibrationProblem& problem;
  const SpringParameters& parameters;
  EvaluationAccount& account;
  const Stage& stage;
  nlopt_opt search;
  std::vector<double> stable{};  // the last point at which every load rested
  double value{};                // what was minimised, there
  long done{0};                  // evaluations of the stage
  std::exception_ptr failure{};
};

std::vector<double> all_of(const SpringParameters& parameters, const Stage& stage,
                           std::span<const double> x) {
  return stage.even ? parameters.even(std::span<const double, kEven>(x.data(), kEven))
                    : std::vector<double>(x.begin(), x.end());
}

/// Stands for what is minimised where a load finds no rest: a cone that rises from the last stable
/// point, so that the search comes back by a part of its step and no unstable point is a wall.
double damped(const DescentCall& call, std::span<const double> x, std::span<double> slope) {
  double square = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    slope[i] = x[i] - call.stable[i];
    square += slope[i] * slope[i];
  }
  const double distance = std::sqrt(square);
  for (double& s : slope) {
    s *= call.value / distance;
  }
  return call.value * (1.0 + distance);
}

/// @returns what is minimised; sets its slope by x.
double evaluate_stage(DescentCall& call, std::span<const double> x, std::span<double> slope) {
  std::vector<double> logarithms = all_of(call.parameters, call.stage, x);
  const CalibrationError found =
      call.problem.error(call.parameters.constants(logarithms), true, call.account.threads());
  std::ranges::fill(slope, 0.0);
  double value = found.mean;
  if (std::isinf(value)) {
    value = damped(call, x, slope);
  } else {
    const std::vector<double> all = call.parameters.gradient(logarithms, found.gradient);
    for (std::size_t i = 0; i < all.size(); ++i) {
      slope[call.stage.even ? kind_of(call.parameters, i) : i] += all[i];
    }
    if (!call.stage.even) {
      value += EvenPrior(call.parameters, call.stage.prior).add(x, slope);
    }
    call.stable.assign(x.begin(), x.end());
    call.value = value;
  }
  call.account.add(step_of(std::move(logarithms), found));
  return value;
}

double evaluate_descent(unsigned size, const double* x, double* gradient, void* data) noexcept {
  auto& call = *static_cast<DescentCall*>(data);
  try {
    std::vector<double> unused(gradient == nullptr ? size : 0);
    const double value =
        evaluate_stage(call, {x, size}, {gradient == nullptr ? unused.data() : gradient, size});
    const bool idle = call.stage.patience > 0 && ++call.done > call.stage.patience &&
                      call.account.since_best() > call.stage.patience;
    if (call.account.over() || idle) {
      nlopt_force_stop(call.search);
    }
    return value;
  } catch (...) {
    call.failure = std::current_exception();
    nlopt_force_stop(call.search);
    return call.value;
  }
}

void run_stage(const CalibrationProblem& problem, const SpringParameters& parameters,
               const SearchRange& range, EvaluationAccount& account, const Stage& stage,
               std::vector<double>& x) {
  constexpr double kSameError = 1e-6, kSamePlace = 1e-6;  // relative; absolute, of logarithms
  const std::unique_ptr<std::remove_pointer_t<nlopt_opt>, decltype(&nlopt_destroy)> search(
      nlopt_create(NLOPT_LD_LBFGS, static_cast<unsigned>(x.size())), nlopt_destroy);
  DescentCall call{problem, parameters, account, stage, search.get(), x, account.nearest()};
  nlopt_set_lower_bounds1(search.get(), range.low);
  nlopt_set_upper_bounds1(search.get(), range.high);
  nlopt_set_min_objective(search.get(), evaluate_descent, &call);
  nlopt_set_ftol_rel(search.get(), kSameError);
  nlopt_set_xtol_abs1(search.get(), kSamePlace);
  nlopt_set_maxeval(search.get(), static_cast<int>(std::max(stage.evaluations, 1L)));
  double least = 0.0;
  nlopt_optimize(search.get(), x.data(), &least);
  if (call.failure) {
    std::rethrow_exception(call.failure);
  }
}

CalibrationStep evaluated(const CalibrationProblem& problem, const SpringParameters& parameters,
                          const EvaluationAccount& account, const std::vector<double>& at) {
  return step_of(at, problem.error(parameters.constants(at), false, account.threads()));
}

/// Three even constants from which a descent may begin; empty if evaluations ran out. Constants
/// that balance the forces at the reference may leave kinds of springs out, and a body without them
/// may have no rest: each is also raised to a share of the largest.
std::vector<double> even_start(const CalibrationProblem& problem,
                               const SpringParameters& parameters,
                               const CalibrationSettings& settings, EvaluationAccount& account) {
  constexpr std::size_t kTried = 8;
  constexpr std::array kShares{-5.0, -3.0, -1.0};  // common logarithms
  std::vector<ThreeLogarithms> starts;
  if (parameters.size() == kEven) {
    const std::vector<double> balanced = starting_constants(problem, parameters, settings.ranges);
    const double most = *std::ranges::max_element(balanced);
    for (const double share : kShares) {
      ThreeLogarithms& raised = starts.emplace_back();
      for (std::size_t i = 0; i < kEven; ++i) {
        raised[i] = std::max(balanced[i], std::max(most + share, settings.ranges[i].low));
      }
    }
  }
  const auto global = global_starts(problem, parameters, settings.ranges);
  for (std::size_t i = 0; i < std::min(kTried, global.size()); ++i) {
    starts.push_back(global[i].logarithms);
  }
  std::vector<double> best;
  for (const ThreeLogarithms& start : starts) {
    if (account.over()) {
      break;
    }
    const double before = account.nearest();
    account.add(evaluated(problem, parameters, account, parameters.even(start)));
    if (account.nearest() < before) {
      best.assign(start.begin(), start.end());
    }
  }
  return best;
}

/// The best of coarse samples, where no even start rests.
std::vector<double> sampled_start(const CalibrationProblem& problem,
                                  const SpringParameters& parameters,
                                  const CalibrationSettings& settings, EvaluationAccount& account) {
  const std::vector<SearchRange> three(kEven, settings.ranges[0]);
  Annealing samples(three, settings.seed, settings.annealing);
  std::vector<double> best;
  for (const std::vector<double>& point : samples.ask()) {
    if (account.over()) {
      break;
    }
    const double before = account.nearest();
    const auto all = parameters.even(std::span<const double, kEven>(point.data(), kEven));
    account.add(evaluated(problem, parameters, account, all));
    if (account.nearest() < before) {
      best = point;
    }
  }
  return best;
}

}  // namespace

void descend(const CalibrationProblem& problem, const SpringParameters& parameters,
             const CalibrationSettings& settings, EvaluationAccount& account) {
  constexpr std::array kPriors{1.0, 0.1, 0.01, 0.001};
  constexpr long kPatience = 20;  // evaluations
  account.take_known();
  std::vector<double> x = account.best();
  if (x.empty()) {
    std::vector<double> three = even_start(problem, parameters, settings, account);
    if (three.empty()) {
      three = sampled_start(problem, parameters, settings, account);
    }
    if (three.empty() || account.over()) {
      return;
    }
    run_stage(problem, parameters, settings.ranges[0], account,
              {.even = true, .evaluations = account.left()}, three);
    x = account.best();
  } else if (parameters.size() == kEven && !account.over()) {
    run_stage(problem, parameters, settings.ranges[0], account,
              {.even = true, .evaluations = account.left()}, x);
  }
  const double even_error = account.nearest();
  const bool judged = settings.held_out != nullptr;
  for (std::size_t i = 0; parameters.size() > kEven && i < kPriors.size(); ++i) {
    if (account.over()) {
      break;
    }
    const auto stages = static_cast<long>(kPriors.size() - i);
    x = account.best();
    run_stage(problem, parameters, settings.ranges[0], account,
              {.prior = kPriors[i] * even_error,
               .evaluations = account.left() / stages,
               .patience = judged ? kPatience : 0},
              x);
  }
}

}  // namespace haptrial::deformable
