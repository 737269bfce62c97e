#pragma once

#include <string>
#include <vector>

#include "analysis/psychometric/models/diffusion.h"
#include "analysis/psychophysics/data/trials_data.h"
#include "analysis/psychophysics/fit/trials_plan.h"
#include "analysis/statistics/base/defined.h"
#include "analysis/statistics/relation/regression.h"

namespace haptrial::analysis::trials {

/// Times and verdicts of a participant under a condition.
struct TimedCondition {
  std::string participant;
  std::string condition;            // levels joined by ", "; empty: there is one condition
  std::vector<std::string> levels;  // of TrialsPlan::by
  std::size_t trials{0};            // that count
  std::size_t judged{0};            // answers that are right or wrong
  std::size_t wrong{0};
  std::vector<double> times;                                // of trials without a wrong answer [s]
  std::vector<double> times_at;                             // (times) level of each; NaN: none
  Defined<double> mean{Undefined{"no time was measured"}};  // of `times` [s]
  Defined<double> median{Undefined{"no time was measured"}};
  std::vector<TimedChoice> choices;  // answers 1 at the upper boundary, with their times
  Defined<DiffusionFit> diffusion{Undefined{"it was not asked for"}};
  Defined<Regression> line{Undefined{"no level was named"}};  // of `times` on their levels

  /// NaN: no answer is right or wrong.
  double share_wrong() const {
    return judged > 0 ? static_cast<double>(wrong) / static_cast<double>(judged) : kNotKnown;
  }
};

/// By participant, then condition. A time is the reaction time of the answer, or how long
/// TrialsPlan::stage lasted in the trial's last interval, if its end was reached. The time of a
/// wrong answer counts in the diffusion model alone, which the plan asks for. Lines are fitted if
/// the definition names a level.
std::vector<TimedCondition> timed(const TrialsData& data, const TrialsPlan& plan);

/// The unit of a time's slope over the level: "s per stiffness".
std::string slope_unit(const TrialsPlan& plan);

}  // namespace haptrial::analysis::trials
