#pragma once

#include <filesystem>

#include "analysis/document/finding.h"
#include "analysis/force_training/study/study_result.h"

namespace haptrial::analysis {

/// Writes scores.csv, statistics.json, every figure as SVG and PNG, and report.html into a folder,
/// which is created when absent. All are made in a folder beside their place and moved there at the
/// end, each at once: an earlier analysis is replaced, never half-written.
/// @param own  findings of a program of one's own; own_findings.csv if there are any
/// @throws InputError when `folder` is not a folder or may not be written; RunError when the disk
/// is full or gnuplot is absent or fails.
void write_analysis(const StudyResult& study, const std::filesystem::path& folder, int paper = 0,
                    const std::vector<FindingList>& own = {});

}  // namespace haptrial::analysis
