#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "core/deformable/calibration/calibration_settings.h"

namespace haptrial::deformable {

/// Keeps the account of evaluations; takes known ones where they are the same.
class EvaluationAccount {
 public:
  EvaluationAccount(const SpringParameters& parameters, const CalibrationSettings& settings,
                    CalibrationResult& result)
      : parameters_(parameters), settings_(settings), result_(result) {}

  bool over() const {
    return static_cast<long>(result_.steps.size()) >= settings_.evaluations ||
           nearest_ <= settings_.enough;
  }
  /// The least error of the loads that are followed [m].
  double nearest() const { return nearest_; }
  const std::vector<double>& best() const { return result_.logarithms; }
  /// Evaluations since the kept constants were found.
  long since_best() const { return static_cast<long>(result_.steps.size()) - best_at_; }
  long left() const { return settings_.evaluations - static_cast<long>(result_.steps.size()); }
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

  /// Held-out loads are asked where the followed ones came nearer than ever.
  void add(CalibrationStep step) {
    const bool fresh = known(step.logarithms) == nullptr;
    const bool nearer = step.error < nearest_;
    if (fresh && nearer && settings_.held_out != nullptr) {
      step.held_out =
          settings_.held_out->error(parameters_.constants(step.logarithms), false, threads()).mean;
    }
    nearest_ = std::min(nearest_, step.error);
    keep_best(step, nearer);
    if (settings_.tell && fresh) {
      settings_.tell(step);
    }
    result_.steps.push_back(std::move(step));
  }

 private:
  /// Held-out loads decide; as long as none of them rests, the nearest constants are kept.
  void keep_best(const CalibrationStep& step, bool nearer) {
    const bool better = step.held_out < result_.held_out;
    if (better || (nearer && std::isinf(result_.held_out))) {
      result_.error = step.error;
      result_.held_out = step.held_out;
      result_.logarithms = step.logarithms;
      best_at_ = static_cast<long>(result_.steps.size()) + 1;
    }
  }

  const SpringParameters& parameters_;
  const CalibrationSettings& settings_;
  CalibrationResult& result_;
  double nearest_{std::numeric_limits<double>::infinity()};
  long best_at_{0};
};

/// One evaluation of the problem's error at logarithms.
inline CalibrationStep step_of(std::vector<double> logarithms, const CalibrationError& found) {
  CalibrationStep step;
  step.logarithms = std::move(logarithms);
  step.error = found.mean;
  step.unstable = found.unstable;
  return step;
}

/// Descent by gradients (NLopt, L-BFGS): three even constants first, from the best of
/// global_starts() and starting_constants(). More parameters begin there and follow
///
///     error + w e0 mean((x - its kind's mean)²)
///
/// with a prior towards even constants that grows weaker in stages, w = 1, 0.1, 0.01 and 0.001; x
/// are the logarithms and e0 is the error of the even constants. A stage ends when held-out loads
/// have not been followed better for some time.
void descend(const CalibrationProblem& problem, const SpringParameters& parameters,
             const CalibrationSettings& settings, EvaluationAccount& account);

}  // namespace haptrial::deformable
