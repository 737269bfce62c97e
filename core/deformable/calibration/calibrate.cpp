#include "core/deformable/calibration/calibrate.h"

#include <fmt/format.h>
#include <algorithm>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/deformable/calibration/descent.h"

namespace haptrial::deformable {
namespace {

/// The next of the points that are asked for, few enough that a run that is killed loses little.
/// @param first  of them
std::vector<CalibrationStep> evaluated_next(const CalibrationProblem& problem,
                                            const SpringParameters& parameters,
                                            const CalibrationSettings& settings,
                                            const EvaluationAccount& account,
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
            const CalibrationSettings& settings, EvaluationAccount& account) {
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
  EvaluationAccount account(parameters, settings, result);
  if (settings.method == CalibrationMethod::kAnnealing) {
    anneal(problem, parameters, settings, account);
  } else {
    descend(problem, parameters, settings, account);
  }
  return result;
}

}  // namespace haptrial::deformable
