#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "analysis/document/finding.h"
#include "experiments/plan/audit/study_facts.h"
#include "protocols/definition/definition.h"

namespace haptrial::experiments {

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
