#pragma once

#include <string>
#include <vector>

#include "analysis/psychometric/models/magnitude.h"
#include "analysis/psychophysics/data/trials_data.h"
#include "analysis/psychophysics/fit/trials_plan.h"

namespace haptrial::analysis::trials {

/// Stevens' power law of the participants under a condition.
struct MagnitudeCondition {
  std::vector<std::string> levels;  // of the plan's factors
  std::string condition;
  std::vector<std::string> participants;  // by the numbers in `law`
  std::vector<MagnitudeTrial> trials;
  Defined<PowerLaw> law{Undefined{"nothing was fitted"}};
  std::vector<std::string> one_level;  // participants who answered at one level only: left out
  std::size_t not_positive{0};  // answers or measures of 0 or below, without logarithm: left out
};

/// Answers are numbers in proportion to what was felt.
std::vector<MagnitudeCondition> magnitudes(const TrialsData& data, const TrialsPlan& plan);

}  // namespace haptrial::analysis::trials
