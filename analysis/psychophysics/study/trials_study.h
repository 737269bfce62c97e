#pragma once

#include "analysis/psychophysics/study/trials_result.h"

namespace haptrial::analysis::trials {

/// Computes what the plan asks for from the trials of a study.
/// @param procedure_of  as track_estimates()
/// @throws InputError where no trial counts, or for a planned test that cannot be made of the
/// conditions.
TrialsResult analyze(TrialsData data, const TrialsPlan& plan, const ProcedureOf& procedure_of,
                     int threads);

}  // namespace haptrial::analysis::trials
