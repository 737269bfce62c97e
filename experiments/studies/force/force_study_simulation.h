#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "analysis/force_training/study/study.h"
#include "core/base/definition/table.h"
#include "experiments/studies/curve_analysis.h"
#include "experiments/studies/study.h"
#include "protocols/force_training/force_definition.h"

namespace haptrial::experiments {

/// The report on force curves for simulated participants. At the level of responses a trial is its
/// score,
///
///     mean + effect(condition) + participant + participant × condition + block + trial
///
/// with independent normal parts, the random terms of the report's mixed model; the order of the
/// conditions is that of the sessions. Of power.responses:
///
///     mean                      of the score in a condition without an effect
///     participant, interaction, block, trial   standard deviations of the parts
///     [effects]                 CONDITION = number, as the difference from the mean
///
/// Studies of several sessions are simulated in full alone: as a dry run runs them and the report
/// analyses them, with the tests of changes from the baseline.
///
/// @param definition  outlives what comes back
/// @param asked_in    file with [power]
/// @throws InputError for keys that are missing or no conditions of the definition
std::unique_ptr<StudySimulation> force_study_simulation(
    const protocols::ForceDefinition& definition, const std::string& asked_in,
    CurveAnalysis curves);

/// Analyses the sessions of a force training: recalls right after training, and, if the definition
/// has several sessions, the changes from a baseline to its tests.
/// @throws InputError as analysis::analyze_study()
analysis::StudyResult analyze_training(const protocols::ForceDefinition& definition,
                                       const CurveAnalysis& curves,
                                       const std::vector<std::filesystem::path>& files,
                                       int threads);

}  // namespace haptrial::experiments
