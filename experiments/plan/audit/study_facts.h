#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "core/record/read/trial_progress.h"
#include "core/record/rows/session_types.h"

namespace haptrial::experiments {

/// The facts of a session file that are compared with a plan.
struct SessionFacts {
  std::filesystem::path file;
  std::string name;          // with "excluded/" in front if it lies there
  std::string sha256{};      // of the file; empty until somebody needs it
  std::string unreadable{};  // why; empty: the rest is known
  record::SessionInfo info{};
  record::TrialProgress progress{};
  std::vector<std::string> definitions{};  // that it was recorded with, in their order
  std::vector<std::string> plan_events{};  // a text for each of its runs under a plan
  bool declined{false};
  bool excluded{false};

  /// Whether an analysis counts it.
  bool counts() const { return unreadable.empty() && !declined && !excluded && !info.pilot; }
};

/// The sessions of a study's folder and of "excluded" below it, by name.
std::vector<SessionFacts> session_facts(const std::filesystem::path& folder);

/// Sessions that each participant had, of those that count.
std::map<std::string, std::set<int>> sessions_had(const std::vector<SessionFacts>& sessions);

/// Reasons in excluded/reasons.csv by participant.
std::map<std::string, std::vector<std::string>> exclusion_reasons(
    const std::filesystem::path& folder);

}  // namespace haptrial::experiments
