#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "analysis/document/finding.h"
#include "experiments/plan/audit/study_methods.h"
#include "experiments/plan/plan_log.h"

namespace haptrial::experiments {

/// A way in which a study was done otherwise than its plan states.
struct Deviation {
  std::string kind;  // a word: "people_missing"
  std::string what;  // a sentence that names people, files or keys
};

/// A plan, its log, and the sessions beside them.
struct PlannedStudy {
  StudyPlan plan;
  PlanLog log;
  std::vector<SessionFacts> sessions;
  std::map<std::string, std::vector<std::string>> reasons;  // of exclusions, by participant
  std::optional<int> ended{};  // participants after whom a stated rule ended the study
};

/// @param plan  file in the folder of its sessions. @throws InputError if it cannot be read
PlannedStudy planned_study(const std::filesystem::path& plan);

/// Every deviation, those of the same kind together. Pilots count only as files.
std::vector<Deviation> deviations_of(const PlannedStudy& study);

/// How many sessions the plan states for a participant, by the group of the identifier.
int sessions_of(const StudyPlan& plan, const std::string& subject);

/// The parts of it: participants, their sessions and trials; definition, tests and program; files
/// and the log of what was done.
void add_people(const PlannedStudy& study, std::vector<Deviation>& deviations);
void add_exclusions(const PlannedStudy& study, std::vector<Deviation>& deviations);
void add_trials(const PlannedStudy& study, std::vector<Deviation>& deviations);
void add_definitions(const PlannedStudy& study, std::vector<Deviation>& deviations);
void add_programs(const PlannedStudy& study, std::vector<Deviation>& deviations);
void add_analyses(const PlannedStudy& study, std::vector<Deviation>& deviations);
void add_plans_of_sessions(const PlannedStudy& study, std::vector<Deviation>& deviations);
void add_files(const PlannedStudy& study, std::vector<Deviation>& deviations);

/// "Stated and done" at the head of a report, for sessions beside a plan; nothing without one.
analysis::FindingList stated_and_done(const std::vector<std::filesystem::path>& sessions);

/// Adds stated_and_done() to what analyses find. A second call does nothing.
void add_stated_and_done();

/// Adds an analysis of a folder to the log of its plan, if it has one: how many participants had
/// every session, and what was given in place of the definition's tests.
void note_analysis(const std::filesystem::path& folder, const std::vector<std::string>& given);
/// Adds that it failed, so that nothing of it was seen.
void note_failed_analysis(const std::filesystem::path& folder);

}  // namespace haptrial::experiments
