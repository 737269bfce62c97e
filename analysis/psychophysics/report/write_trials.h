#pragma once

#include <filesystem>

#include "analysis/document/finding.h"
#include "analysis/psychophysics/study/trials_result.h"

namespace haptrial::analysis::trials {

/// report.html, report.md, results.json, trials.csv, estimates.csv, reaches.csv of a study of
/// reaches and figures (SVG and PNG) into a folder, all or none; own_findings.csv if there are any.
/// @param own  findings of a program of one's own. @throws InputError, RunError as Staging and
/// draw_figures() do.
void write_trials(const TrialsResult& result, const std::filesystem::path& folder, int paper = 0,
                  const std::vector<FindingList>& own = {});

}  // namespace haptrial::analysis::trials
