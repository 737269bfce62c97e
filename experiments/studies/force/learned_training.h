#pragma once

#include <filesystem>
#include <vector>

#include "analysis/force_training/study/study.h"
#include "experiments/studies/curve_analysis.h"
#include "protocols/force_training/force_definition.h"

namespace haptrial::experiments {

/// Analyses the sessions of a force training: recalls right after training, and, if the definition
/// has several sessions, the changes from a baseline to its tests.
/// @throws InputError as analysis::analyze_study()
analysis::StudyResult analyze_training(const protocols::ForceDefinition& definition,
                                       const CurveAnalysis& curves,
                                       const std::vector<std::filesystem::path>& files,
                                       int threads);

}  // namespace haptrial::experiments
