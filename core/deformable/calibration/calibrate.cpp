#include "core/deformable/calibration/calibrate.h"

#include <fmt/format.h>
#include <nlopt.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/deformable/calibration/starting_constants.h"

namespace haptrial::deformable {
namespace {

/// Keeps the account of evaluations; takes known ones where they are the same.
class Account {
 public:
  Account(const CalibrationSettings& settings, CalibrationResult& result)
      : settings_(settings), result_(result) {}

  bool over() const {
    return static_cast<long>(result_.steps.size()) >= settings_.evaluations ||
           result_.error <= settings_.enough;
  }
  double error() const { return result_.error; }
  const std::vector<double>& best() const { return result_.logarithms; }
  /// The recorded evaluation that comes `ahead` after the last; null: none of this point.
  const CalibrationStep* known(const std::vector<double>& logarithms, std::size_t ahead = 0) const {
    const std::size_t at = result_.steps.size() + ahead;
    const bool same = at < settings_.known.size() && settings_.known[at].logarithms == logarithms;
    return same ? &settings_.known[at] : nullptr;
  }
  /// Takes all recorded evaluations, in place of doing them.
  void take_known() {
    for (const CalibrationStep& step : settings_.known) {
      add(step);
    }
  }
  int threads() const { return settings_.threads; }
  void add(CalibrationStep step) {
    if (step.error < result_.error) {
      result_.error = step.error;
      result_.logarithms = step.logarithms;
    }
    if (settings_.tell && known(step.logarithms) == nullptr) {
      settings_.tell(step);
    }
    result_.steps.push_back(std::move(step));
  }

 private:
  const CalibrationSettings& settings_;
  CalibrationResult& result_;
};

CalibrationStep step_of(std::vector<double> logarithms, const CalibrationError& found) {
  return {std::move(logarithms), found.mean, found.unstable};
}

/// The next of the points that are asked for, few enough that a run that is killed loses little.
/// @param first  of them
std::vector<CalibrationStep> evaluated_next(const CalibrationProblem& problem,
                                            const SpringParameters& parameters,
                                            const CalibrationSettings& settings,
                                            const Account& account,
                                            const std::vector<std::vector<double>>& points,
                                            std::size_t first) {
  constexpr std::size_t kEach = 2;  // for a thread
  const std::size_t most = kEach * static_cast<std::size_t>(std::max(settings.threads, 1));
  std::vector<CalibrationStep> steps(std::min(most, points.size() - first));
  parallel_for(steps.size(), settings.threads, [&](std::size_t i) {
    const auto& point = points[first + i];
    const CalibrationStep* known = account.known(point, i);
    steps[i] = known != nullptr ? *known
                                : step_of(point, problem.error(parameters.constants(point), false));
  });
  return steps;
}

void anneal(const CalibrationProblem& problem, const SpringParameters& parameters,
            const CalibrationSettings& settings, Account& account) {
  Annealing annealing(settings.ranges, settings.seed, settings.annealing);
  while (!account.over()) {
    const auto& points = annealing.ask();
    std::vector<double> costs;
    while (costs.size() < points.size()) {
      for (CalibrationStep& step :
           evaluated_next(problem, parameters, settings, account, points, costs.size())) {
        costs.push_back(step.error);
        account.add(std::move(step));
      }
    }
    annealing.tell(costs);
  }
}

/// Context of NLopt's callback.
struct DescentCall {
  const CalibrationProblem& problem;
  const SpringParameters& parameters;
  Account& account;
  nlopt_opt search;
  double worst;  // stands for unstable constants: farther than any that rest
  std::exception_ptr failure;
};

double evaluate_descent(unsigned size, const double* x, double* gradient, void* data) noexcept {
  auto& call = *static_cast<DescentCall*>(data);
  try {
    std::vector<double> logarithms(x, x + size);
    const CalibrationError found = call.problem.error(call.parameters.constants(logarithms),
                                                      gradient != nullptr, call.account.threads());
    if (gradient != nullptr) {
      const std::vector<double> slope = std::isfinite(found.mean)
                                            ? call.parameters.gradient(logarithms, found.gradient)
                                            : std::vector<double>(size, 0.0);
      std::copy(slope.begin(), slope.end(), gradient);
    }
    const double error = found.mean;
    call.account.add(step_of(std::move(logarithms), found));
    if (call.account.over()) {
      nlopt_force_stop(call.search);
    }
    return std::isfinite(error) ? error : call.worst;
  } catch (...) {
    call.failure = std::current_exception();
    nlopt_force_stop(call.search);
    return call.worst;
  }
}

double size_of(const SpringBody& body) {
  Eigen::Vector3d low = body.rest.front(), high = low;
  for (const Eigen::Vector3d& p : body.rest) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  return (high - low).norm();
}

CalibrationStep evaluated(const CalibrationProblem& problem, const SpringParameters& parameters,
                          const Account& account, const std::vector<double>& at) {
  return step_of(at, problem.error(parameters.constants(at), false, account.threads()));
}

/// Balanced forces may leave kinds of springs out, and a body without them may have no rest: then
/// every constant is raised to a growing share of the largest. If nothing rests, coarse samples.
/// @returns logarithms; empty if evaluations ran out
std::vector<double> stable_start(const CalibrationProblem& problem,
                                 const SpringParameters& parameters,
                                 const CalibrationSettings& settings, Account& account) {
  constexpr double kFirstShare = -5.0, kLastShare = 0.0;  // common logarithms
  const std::vector<double> balanced = starting_constants(problem, parameters, settings.ranges);
  const double most = *std::max_element(balanced.begin(), balanced.end());
  for (double share = kFirstShare; share <= kLastShare && !account.over(); share += 1.0) {
    std::vector<double> raised;
    for (std::size_t i = 0; i < balanced.size(); ++i) {
      raised.push_back(std::clamp(std::max(balanced[i], most + share), settings.ranges[i].low,
                                  settings.ranges[i].high));
    }
    account.add(evaluated(problem, parameters, account, raised));
    if (std::isfinite(account.error())) {
      return raised;
    }
  }
  Annealing samples(settings.ranges, settings.seed, settings.annealing);
  for (const std::vector<double>& point : samples.ask()) {
    if (account.over()) {
      break;
    }
    account.add(evaluated(problem, parameters, account, point));
  }
  return account.best();
}

void descend(const CalibrationProblem& problem, const SpringParameters& parameters,
             const CalibrationSettings& settings, Account& account) {
  constexpr double kSameError = 1e-6, kSamePlace = 1e-6;  // relative; absolute, of logarithms
  account.take_known();
  std::vector<double> x = account.best();
  if (x.empty() && !account.over()) {
    x = stable_start(problem, parameters, settings, account);
  }
  if (x.empty() || account.over()) {
    return;
  }
  const auto size = static_cast<unsigned>(x.size());
  const std::unique_ptr<std::remove_pointer_t<nlopt_opt>, decltype(&nlopt_destroy)> search(
      nlopt_create(NLOPT_LD_LBFGS, size), nlopt_destroy);
  std::vector<double> low, high;
  for (const SearchRange& range : settings.ranges) {
    low.push_back(range.low);
    high.push_back(range.high);
  }
  DescentCall call{problem, parameters, account, search.get(), size_of(problem.body()), nullptr};
  nlopt_set_lower_bounds(search.get(), low.data());
  nlopt_set_upper_bounds(search.get(), high.data());
  nlopt_set_min_objective(search.get(), evaluate_descent, &call);
  nlopt_set_ftol_rel(search.get(), kSameError);
  nlopt_set_xtol_abs1(search.get(), kSamePlace);
  double least = 0.0;
  nlopt_optimize(search.get(), x.data(), &least);
  if (call.failure) {
    std::rethrow_exception(call.failure);
  }
}

}  // namespace

std::string_view name_of(CalibrationMethod method) {
  return method == CalibrationMethod::kAnnealing ? "annealing" : "descent";
}

CalibrationResult calibrate(const CalibrationProblem& problem, const SpringParameters& parameters,
                            const CalibrationSettings& settings) {
  if (settings.ranges.size() != parameters.size()) {
    throw InputError(fmt::format("calibration: {} ranges are given for {} parameters",
                                 settings.ranges.size(), parameters.size()));
  }
  if (settings.evaluations < 1) {
    throw InputError(
        fmt::format("calibration: {} evaluations; allowed: 1 or more", settings.evaluations));
  }
  CalibrationResult result;
  Account account(settings, result);
  if (settings.method == CalibrationMethod::kAnnealing) {
    anneal(problem, parameters, settings, account);
  } else {
    descend(problem, parameters, settings, account);
  }
  return result;
}

}  // namespace haptrial::deformable
