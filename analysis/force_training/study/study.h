#pragma once

#include <filesystem>
#include <vector>

#include "analysis/force_training/study/study_result.h"
#include "analysis/statistics/design/analysis_plan.h"

namespace haptrial::analysis {

struct ScoreParameters;

/// Reads session files, scores every completed test pass and analyses the scores.
/// One thread works on one file at a time, up to `jobs`; only the pictured curves stay in memory.
/// The result does not depend on `jobs` nor on the order of the files.
/// @throws InputError when there is no file, a file cannot be read, or two files share a subject
/// and its session. Source: Morris 2006, §4.3 and §4.4.
/// @param plan  the tests that were planned
/// @param planned_sessions  of each participant; scores of those that only test are kept apart
StudyResult analyze_study(const std::vector<std::filesystem::path>& session_files,
                          const ScoreParameters& parameters, int jobs,
                          const AnalysisPlan& plan = {},
                          const std::vector<SessionOfStudy>& planned_sessions = {});

}  // namespace haptrial::analysis
