#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "analysis/psychophysics/exchange/imported_trials.h"
#include "core/record/rows/session_types.h"
#include "core/record/table/table.h"

namespace haptrial::analysis::trials {

/// Names that the definition of imported trials gives what their columns hold.
struct ImportedNames {
  std::string answer;                // question of the answers
  std::vector<std::string> choices;  // of that question, in its order; none: a number
  double first{1.0};                 // number of the first choice
  std::string rating;                // question of the ratings
  std::string level;                 // variable that is the level
  bool level_is_set{false};          // by a procedure, so that it stands in /levels
  std::string track;                 // of levels, where the table has no column of tracks
};

/// Writes the trials of one session as a session file without samples. An event says which file
/// they are from; the numbers of their ticks count trials.
/// @param trials  of one participant's session, in their order
/// @param tables  of protocol "trials"
/// @throws InputError when the file exists, or an answer is no choice of the definition, naming
/// file and line; RunError when it cannot be written
void write_imported(const std::filesystem::path& file, const record::SessionInfo& info,
                    const ImportedStudy& study, const std::vector<const ImportedTrial*>& trials,
                    const ImportedNames& names, const record::TableList& tables);

}  // namespace haptrial::analysis::trials
