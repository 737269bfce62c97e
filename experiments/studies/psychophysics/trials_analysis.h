#pragma once

#include <filesystem>
#include <vector>

#include "analysis/psychophysics/fit/track_estimate.h"
#include "analysis/psychophysics/fit/trials_plan.h"
#include "analysis/psychophysics/study/trials_result.h"

namespace haptrial::protocols {
struct TrialsDefinition;
}

namespace haptrial::protocols {
struct TrialsDefinition;
}

namespace haptrial::experiments {

/// Values of a definition of trials that stand in for keys that [analysis] does not have: the axis
/// and unit of its procedure, the guess rate of its first question, its factors.
analysis::trials::PlanDefaults plan_defaults(const protocols::TrialsDefinition& definition);

/// The table [analysis] of a definition. Problems are noted.
/// @param definition  whose table it is; null if it cannot be read
analysis::trials::TrialsPlan read_trials_analysis(Table& root,
                                                  const protocols::TrialsDefinition* definition);

/// The plan of a definition that was read. @throws InputError for what is wrong with the table
analysis::trials::TrialsPlan plan_of(const protocols::TrialsDefinition& definition);

/// Whether an analysis counts answers 1 or 0, and its plan alone does not say which.
bool needs_judged_answers(const analysis::trials::TrialsPlan& plan);

/// Begins the procedures of a definition anew, by the names that /levels has.
/// @param definition  outlives it
analysis::trials::ProcedureOf procedures_of(const protocols::TrialsDefinition& definition);

/// Adds the quantities of kinds that look at what hands did or at pairs: "reaching", "pursuit",
/// "produced" and "paired". Other kinds have theirs from the answers already.
/// @param files  of the sessions in `result`
/// @throws InputError as the analyses of these kinds do
void add_file_quantities(const protocols::TrialsDefinition& definition,
                         const std::vector<std::filesystem::path>& files, int threads,
                         analysis::trials::TrialsResult& result);

}  // namespace haptrial::experiments
