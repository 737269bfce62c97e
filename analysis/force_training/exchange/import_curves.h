#pragma once

#include "analysis/exchange/export_sessions.h"
#include "analysis/force_training/exchange/curve_study.h"
#include "analysis/force_training/score/score_parameters.h"
#include "analysis/force_training/study/study_result.h"

namespace haptrial::exchange {

/// Scores and tests such a study as analyze_study() does that of session files. What only session
/// files hold (tracking, timing, device, stimulus) stays empty, and StudyResult::curves_from says
/// so. StudyResult::remarks warns about units and signs that cannot be (import_checks.h).
/// @throws InputError, with file and line, for whatever a table or curve has that it should not.
analysis::StudyResult analyze_curves(const CurveStudy& study,
                                     const analysis::ScoreParameters& parameters, int jobs,
                                     const Watch& watch);

}  // namespace haptrial::exchange
