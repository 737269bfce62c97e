#include "experiments/plan/audit/study_facts.h"

#include <algorithm>

#include "analysis/files/csv.h"
#include "core/base/error.h"
#include "core/record/read/definition_versions.h"
#include "core/record/read/session_reader.h"
#include "experiments/plan/plan_log.h"
#include "experiments/study/session_name.h"
#include "experiments/study/study_files.h"

namespace haptrial::experiments {
namespace {

namespace fs = std::filesystem;

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
