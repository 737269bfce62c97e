#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "analysis/document/finding.h"

namespace haptrial::analysis {

/// An analysis that a program adds to that of a study's protocol. Its findings stand in the report,
/// under "own_findings" in its JSON file, in own_findings.csv and on the terminal.
struct FindingSource {
  std::string name;  // letters, digits, '-' and '_'; unlike every other source's
  /// Gets the session files of a study, sorted, which record::SessionReader reads; a study of
  /// `protocol = "trials"` is read by trials::read_trials(). An exception ends the analysis.
  std::function<FindingList(const std::vector<std::filesystem::path>& sessions)> find;
};

/// Adds a source; those of the sessions' channels and devices' certificates are there. Call before
/// threads are started.
/// @throws std::invalid_argument for a name with another character, or one that is empty or taken
void add_finding_source(FindingSource source);

/// Findings of all sources, in the order in which they were added. A list gets its source's name;
/// heading and figures say if a participant is simulated; files of figures begin with "own-NAME-".
/// @throws InputError as the sources do; RunError for a finding without a name, or with one that is
/// a value and a group at once
std::vector<FindingList> own_findings(const std::vector<std::filesystem::path>& sessions);

}  // namespace haptrial::analysis
