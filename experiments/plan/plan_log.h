#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "experiments/plan/study_plan.h"

namespace haptrial::experiments {

// NAME.plan.log beside a plan among its sessions: who did what, a line each, tab-separated. Lines
// are only added. Each has the digest of the line before and of itself, the first that of the
// plan, so that a line that is changed, taken out or put in breaks the chain behind it.

/// The words for what was done, one in each line.
inline constexpr const char* kSessionClosed = "session";           // begun=TIME sha256=DIGEST
inline constexpr const char* kAnalysed = "analysis";               // people=7 tests=definition
inline constexpr const char* kAnalysisFailed = "analysis_failed";  // of which nothing was seen
inline constexpr const char* kExcluded = "exclusion";              // sha256=DIGEST ...
inline constexpr const char* kWithdrawn = "withdrawal";            // sha256=DIGEST ...
inline constexpr const char* kPlanEvent = "plan";  // event of a session that has a plan

/// The values that a text of NAME=VALUE, separated by spaces, has under a name; a value goes up to
/// the next name.
std::vector<std::string> values_in(const std::string& text, const std::string& name);

struct PlanEntry {
  std::string time;    // UTC
  std::string login;   // of who did it
  std::string what;    // one of the words above
  std::string detail;  // NAME=VALUE, separated by spaces
  std::string link;    // digest

  std::vector<std::string> values(const std::string& name) const { return values_in(detail, name); }
};

struct PlanLog {
  std::vector<PlanEntry> entries;
  std::string broken;  // where the chain breaks, in words; empty: it holds
  std::string head;    // link of the last line; the plan's digest without one
};

std::filesystem::path log_beside(const std::filesystem::path& plan);
/// @throws InputError if the plan or its log cannot be read
PlanLog read_plan_log(const std::filesystem::path& plan);
/// Adds a line; several processes may do so at once. @throws RunError in the words of the system
void note_in_log(const std::filesystem::path& plan, const std::string& what,
                 const std::string& detail);

/// Places of the analyses of which something was seen: those that did not fail.
std::vector<std::size_t> seen_analyses(const PlanLog& log);

/// "plan=DIGEST link=DIGEST" for an event of a session that begins in a folder; empty without a
/// plan there.
std::string plan_event(const std::filesystem::path& folder);
/// Adds a session file that was closed to the log of the plan beside it, if there is one.
void note_closed_session(const std::filesystem::path& file);
/// Adds what was done with files to the log of the plan in a folder, if there is one.
/// @param digests  of the files, as they were
void note_files(const std::filesystem::path& folder, const std::string& what,
                const std::vector<std::string>& digests);

}  // namespace haptrial::experiments
