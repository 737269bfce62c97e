#pragma once

#include <vector>

#include "analysis/psychophysics/data/page_scores.h"
#include "analysis/statistics/design/analysis_plan.h"

namespace haptrial::analysis::trials {

/// Fills in the values of the covariate PAGE.SCORE: each participant's score of the first time that
/// the page was answered. Nothing happens without a name.
/// @throws InputError if nobody has a score of that name, naming those that there are.
void add_covariate(const std::vector<PageScore>& scores, Covariate& covariate);

}  // namespace haptrial::analysis::trials
