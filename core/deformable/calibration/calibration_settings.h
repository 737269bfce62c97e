#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "core/deformable/calibration/annealing.h"
#include "core/deformable/calibration/calibration_problem.h"
#include "core/deformable/calibration/spring_parameters.h"

namespace haptrial::deformable {

/// kAnnealing: the source's way, which knows costs alone. kDescent: gradients through the statics,
/// from a global start on (descent.h).
enum class CalibrationMethod { kAnnealing, kDescent };
std::string_view name_of(CalibrationMethod method);

/// One evaluation of the error.
struct CalibrationStep {
  std::vector<double> logarithms;
  double error{std::numeric_limits<double>::infinity()};  // infinite: unstable [m]
  std::string unstable;                                   // why, in words
  /// Error of the held-out loads; infinite: unstable, or not asked [m].
  double held_out{std::numeric_limits<double>::infinity()};
};

struct CalibrationSettings {
  CalibrationMethod method{CalibrationMethod::kDescent};
  std::vector<SearchRange> ranges;  // of each parameter's common logarithm
  /// Loads that are not followed: of all constants that come nearer to the followed loads, those
  /// are kept that follow these best. Null: none. Must outlive the search.
  const CalibrationProblem* held_out{nullptr};
  long evaluations{1000};  // at most; a descent ends before
  double enough{0.0};      // ends at this error [m]
  std::uint64_t seed{1};   // of the annealing
  AnnealingOptions annealing{};
  /// Threads for a batch of the annealing, and for the loads in a descent; the result is the same
  /// for any number.
  int threads{1};
  /// Evaluations of an earlier run with the same settings, which are taken and not done again. An
  /// annealing goes on as it would have gone on; a descent begins anew from the best of them.
  std::vector<CalibrationStep> known{};
  /// Callback for every new evaluation, in order.
  std::function<void(const CalibrationStep&)> tell{};
};

struct CalibrationResult {
  std::vector<double> logarithms;  // the best; empty: nothing stable was found
  double error{std::numeric_limits<double>::infinity()};     // of the loads that are followed [m]
  double held_out{std::numeric_limits<double>::infinity()};  // of those held out, if any [m]
  std::vector<CalibrationStep> steps;                        // in order (Figure 36)
};

}  // namespace haptrial::deformable
