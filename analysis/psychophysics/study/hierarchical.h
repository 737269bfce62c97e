#pragma once

#include <string>
#include <vector>

#include "analysis/psychometric/hierarchical/hierarchical_fit.h"
#include "analysis/psychophysics/fit/series.h"
#include "analysis/statistics/base/defined.h"

namespace haptrial::analysis::trials {

/// Hierarchical Bayesian functions of all participants under all conditions.
struct HierarchicalFunctions {
  std::vector<std::string> participants;         // (people of the fit)
  std::vector<std::string> conditions;           // (conditions of the fit) levels joined by ", "
  std::vector<std::vector<std::string>> levels;  // (conditions) of TrialsPlan::by
  std::vector<std::size_t> condition_of;         // (functions of the fit)
  hierarchical::HierarchicalFit fit;
};

/// Undefined with fewer than three participants, or as a model's options and answers are refused.
/// @param series  ordered by participant
Defined<HierarchicalFunctions> hierarchical_functions(const std::vector<AnsweredSeries>& series,
                                                      const TrialsPlan& plan, int threads);

}  // namespace haptrial::analysis::trials
