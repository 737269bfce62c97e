#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "analysis/bone_drilling/metrics/metrics.h"
#include "analysis/bone_drilling/report/checklist_section.h"
#include "analysis/bone_drilling/report/crossing_section.h"
#include "analysis/bone_drilling/report/hint_section.h"
#include "analysis/bone_drilling/report/nerve_findings.h"
#include "analysis/bone_drilling/report/validity_findings.h"
#include "analysis/learning/learned_study.h"

namespace haptrial::analysis::drilling {

/// A picture for the report, as a PNG file.
struct StudyPicture {
  std::string name;  // letters, digits, '-' and '_'
  std::string title;
  std::string caption;
  std::string alt;
  std::filesystem::path png;
};

/// Results of a study from its sessions.
struct ValidityResult {
  std::string title;
  std::vector<ProcedureSummary> procedures;
  NearBins bins;
  std::string structure;  // whose force profile is drawn; empty: none
  Validity validity;
  std::vector<NerveProcedure> nerves;  // of sessions with a nerve monitor
  std::vector<StudyPicture> pictures;
  std::vector<std::string> remarks;    // sentences about the files, for the report
  std::vector<HintProcedure> hints{};  // of sessions that give hints
  std::vector<HintEffect> hint_effects{};
  CheckedStudy checked{};                      // without rows: nobody filled in a checklist
  std::vector<CrossingProcedure> crossings{};  // of sessions with forbidden regions
  LearnedStudy learned{};                      // without outcomes: the definition asks for none
};

}  // namespace haptrial::analysis::drilling
