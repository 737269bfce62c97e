#pragma once

#include <string>
#include <vector>

#include "analysis/psychometric/models/detection.h"
#include "analysis/psychometric/models/rating.h"
#include "analysis/trials/data/trials_data.h"
#include "analysis/trials/psychometric/trials_plan.h"

namespace haptrial::analysis::trials {

/// What a participant detected under a condition.
struct DetectedCondition {
  std::string participant;
  std::vector<std::string> levels;  // of the plan's factors
  std::string condition;
  DetectionCounts counts;
  Defined<Detection> detection{Undefined{"nothing was counted"}};  // log-linear correction
  RatingCounts ratings;                                            // empty: none were asked for
  Defined<Roc> roc{Undefined{"there are no ratings"}};
  Defined<BinormalRoc> binormal{Undefined{"there are no ratings"}};
};

/// Yes/no detection. Signal is every trial in which "yes" is right. If the definition does not say
/// what is right: one with a level above 0 and no probe; noise is then one with a probe (a catch
/// trial) or the level 0. A rating goes from "surely no" to "surely yes": with
/// the answer "no" it counts downwards.
std::vector<DetectedCondition> detected(const TrialsData& data, const TrialsPlan& plan);

}  // namespace haptrial::analysis::trials
