#include "experiments/plan/audit/study_methods.h"

#include <algorithm>

#include "analysis/exchange/own_findings.h"
#include "analysis/files/csv.h"
#include "core/base/error.h"
#include "core/record/read/definition_versions.h"
#include "core/record/read/session_reader.h"
#include "experiments/plan/plan_log.h"
#include "experiments/studies/experiment.h"
#include "experiments/study/session_name.h"
#include "experiments/study/study_files.h"
#include "protocols/interface/recorded_definition.h"

namespace haptrial::experiments {
namespace {

namespace fs = std::filesystem;

/// Reads what only the sessions that are analysed are asked for.
void read_rest(MethodsSession& session) {
  const record::SessionReader reader(session.facts.file);
  session.passes = reader.passes();
  session.seen = !reader.frames().empty();
  session.imported = record::imported_from(reader);
  for (const record::EventRow& event : reader.events()) {
    if (event.kind == "tutor" && !event.text.ends_with("teaches")) {
      session.tutor = event.text.substr(0, event.text.find(" from "));
    }
  }
  for (const record::RunRow& run : reader.runs()) {
    session.ticks += run.counts.ticks;
    session.overruns += run.counts.overruns;
  }
}

std::vector<MethodsSession> sessions_of(const std::vector<fs::path>& analysed) {
  const std::set<fs::path> names(analysed.begin(), analysed.end());
  std::vector<MethodsSession> sessions;
  for (SessionFacts& facts : session_facts(analysed.front().parent_path())) {
    MethodsSession session{std::move(facts)};
    session.analysed = names.contains(session.facts.file);
    if (session.analysed) {
      read_rest(session);
    }
    sessions.push_back(std::move(session));
  }
  return sessions;
}

/// Headings one level down: the list has the heading above them.
void lower_headings(analysis::Document& document) {
  for (auto& block : document.blocks) {
    if (auto* heading = std::get_if<analysis::Document::Heading>(&block)) {
      heading->level = 3;
    }
  }
}

}  // namespace

analysis::FindingList study_methods(const std::vector<fs::path>& analysed) {
  analysis::FindingList list{.name = "methods", .heading = "Methods: participants to procedure"};
  if (analysed.empty()) {
    return list;
  }
  const std::vector<MethodsSession> sessions = sessions_of(analysed);
  if (std::ranges::none_of(sessions, &MethodsSession::analysed)) {
    return list;
  }
  const record::SessionInfo info = largest_plan(analysed);
  const Experiment experiment = parse_experiment(info.definition, info.definition_name);
  analysis::Document document;
  add_participants(sessions, *experiment.definition, document);
  add_imported(sessions, document);
  if (!all_imported(sessions)) {
    add_apparatus(sessions, *experiment.definition, document);
    experiment.study->add_methods(*experiment.definition, info.seed, document);
  }
  add_done(sessions, *experiment.definition, document);
  lower_headings(document);
  list.blocks = std::move(document.blocks);
  return list;
}

void add_study_methods() {
  static const bool added = (analysis::add_finding_source({"methods", study_methods}), true);
  static_cast<void>(added);
}

namespace {

SessionFacts facts_of(const fs::path& file, bool excluded) {
  SessionFacts facts;
  facts.file = file;
  facts.name = (excluded ? std::string(kExcludedFolder) + "/" : "") + file.filename().string();
  facts.excluded = excluded;
  try {
    const record::SessionReader reader(file);
    facts.info = reader.info();
    facts.progress = record::trial_progress(reader);
    facts.declined = is_declined(reader);
    for (const record::DefinitionVersion& version : record::definition_versions(reader)) {
      facts.definitions.push_back(version.text);
    }
    for (const record::EventRow& event : reader.events()) {
      if (event.kind == kPlanEvent) {
        facts.plan_events.push_back(event.text);
      }
      if (event.kind == protocols::kLevelScriptEvent) {
        facts.scripts.push_back(event.text);
      }
    }
  } catch (const InputError& error) {
    facts.unreadable = error.what();
  }
  return facts;
}

void add_folder(const fs::path& folder, bool excluded, std::vector<SessionFacts>& sessions) {
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored)) {
    if (entry.path().extension() == ".h5") {
      sessions.push_back(facts_of(entry.path(), excluded));
    }
  }
}

}  // namespace

std::vector<SessionFacts> session_facts(const fs::path& folder) {
  std::vector<SessionFacts> sessions;
  add_folder(folder, false, sessions);
  add_folder(folder / kExcludedFolder, true, sessions);
  std::ranges::sort(sessions, {}, &SessionFacts::name);
  return sessions;
}

std::map<std::string, std::set<int>> sessions_had(const std::vector<SessionFacts>& sessions) {
  std::map<std::string, std::set<int>> had;
  for (const SessionFacts& each : sessions) {
    if (each.counts()) {
      had[each.info.subject].insert(static_cast<int>(each.info.session));
    }
  }
  return had;
}

std::map<std::string, std::vector<std::string>> exclusion_reasons(const fs::path& folder) {
  std::map<std::string, std::vector<std::string>> reasons;
  const fs::path file = folder / kExcludedFolder / "reasons.csv";
  if (fs::exists(file)) {
    const auto table = analysis::CsvTable::load(file);
    const std::size_t who = table.column("participant"), why = table.column("reason");
    for (std::size_t row = 0; row < table.rows(); ++row) {
      reasons[std::string(table.text(row, who))].emplace_back(table.text(row, why));
    }
  }
  return reasons;
}

}  // namespace haptrial::experiments
