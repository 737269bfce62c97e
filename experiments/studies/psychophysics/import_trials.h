#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "analysis/psychophysics/exchange/imported_definition.h"
#include "analysis/psychophysics/exchange/trial_columns.h"

namespace haptrial::experiments {

/// Trials that another program presented, and how they are to become a study.
struct TrialsImport {
  std::vector<std::filesystem::path> files;
  analysis::trials::TrialColumns columns;
  std::string definition;                       // file of protocol "trials"; empty: one is made
  analysis::trials::ImportedAnalysis analysis;  // of a definition that is made
  std::filesystem::path out;                    // new folder
};

struct ImportSummary {
  std::size_t participants{0};
  std::size_t sessions{0};
  std::size_t trials{0};
  std::size_t left_out{0};    // rows that are no trials
  std::size_t unanswered{0};  // trials without an answer
  std::vector<std::string> warnings;
};

/// Writes a session file for each participant's session and the definition, study.toml, into a
/// folder that appears whole or not at all. Columns that a given definition's factors and level
/// are called by need not be named.
/// @throws InputError for tables, columns or a definition that do not fit together
ImportSummary import_trials(TrialsImport request);

}  // namespace haptrial::experiments
