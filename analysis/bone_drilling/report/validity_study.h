#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "analysis/bone_drilling/metrics/metrics.h"
#include "analysis/bone_drilling/metrics/procedure.h"
#include "analysis/bone_drilling/report/validity_result.h"
#include "analysis/document/finding.h"
#include "core/record/read/session_reader_forward.h"

namespace haptrial::analysis::drilling {

/// A study to be analysed.
struct ValidityStudy {
  std::string title{"Construct validity"};
  std::vector<std::filesystem::path> files;  // sessions, in the order of reports
  /// Reads a session's definition; called from several threads at once.
  std::function<ProcedureSetup(const record::SessionReader&)> setup;
  ValidityPlan plan;
  LearningPlan learning{};         // without outcomes: nobody asks what was learned
  LearningNames learning_names{};  // with outcomes
  MetricOptions metrics;
  /// Structure whose force profile is drawn (Figure 20); empty: the chorda tympani if there are
  /// removals near it, else the structure with most of them.
  std::string structure;
  std::filesystem::path ratings;       // of load_ratings(); a file that is absent: not rated yet
  std::filesystem::path checklist;     // of load_checklist(); empty: none
  std::filesystem::path checked;       // of load_checked(), if there is a checklist
  std::vector<StudyPicture> pictures;  // Figure 18 and others
  int threads{1};
};

/// Reads every session, computes its metrics and the statistics.
/// @throws InputError where a file or the ratings are damaged or do not fit the plan.
ValidityResult analyze(const ValidityStudy& study);

/// report.html, report.md, statistics.json, metrics.csv and figures (SVG and PNG) into a folder,
/// all or none; phases.csv if procedures are divided, own_findings.csv if there are any.
/// @param own  findings of a program of one's own. @throws InputError, RunError as Staging and
/// draw_figures() do.
void write_validity(const ValidityResult& result, const std::filesystem::path& folder,
                    int paper = 0, const std::vector<FindingList>& own = {});

}  // namespace haptrial::analysis::drilling
