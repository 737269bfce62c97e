#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "analysis/document/finding.h"
#include "core/record/read/session_facts.h"
#include "core/record/rows/session_types.h"
#include "protocols/definition/definition.h"

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
  std::vector<std::string> scripts{};      // of levels, that it was recorded with
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

/// The facts of one session that a methods section states, of any protocol.
struct MethodsSession {
  SessionFacts facts;
  bool analysed{false};
  std::vector<record::PassRow> passes{};  // none of a session that is not analysed
  std::uint64_t ticks{0}, overruns{0};    // of the servo loop; 0 ticks: the file does not say
  std::string tutor{};                    // recorded run or session that led the hand; empty: none
  std::string imported{};                 // table of another program; empty: haptrial ran it
  bool seen{false};                       // frames of the participant's window are recorded
};

/// A methods section from the sessions that are analysed, those beside them in their folder, and
/// their definition: participants and exclusions, apparatus, stimuli and procedure
/// (Study::add_methods), trials as planned and as done. Of sessions that were imported it states
/// counts alone, as nobody knows how another program ran them. It stands before the analysis's own
/// methods in the report. Nothing without sessions.
/// @throws InputError if a session cannot be read
analysis::FindingList study_methods(const std::vector<std::filesystem::path>& sessions);

/// Parts of it, each a heading and what stands below it.
bool all_imported(const std::vector<MethodsSession>& sessions);  // of those analysed
void add_participants(const std::vector<MethodsSession>& sessions,
                      const protocols::Definition& definition, analysis::Document& document);
void add_apparatus(const std::vector<MethodsSession>& sessions,
                   const protocols::Definition& definition, analysis::Document& document);
/// States the facts that nobody knows of sessions that another program ran.
void add_imported(const std::vector<MethodsSession>& sessions, analysis::Document& document);
/// Trials as planned and as done, and in how many of each group a tutor led the hand.
void add_done(const std::vector<MethodsSession>& sessions, const protocols::Definition& definition,
              analysis::Document& document);

/// Adds study_methods() to what analyses find. A second call does nothing.
void add_study_methods();

}  // namespace haptrial::experiments
