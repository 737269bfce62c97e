#include "experiments/plan/audit/study_methods.h"

#include <algorithm>
#include <set>

#include "analysis/exchange/own_findings.h"
#include "core/record/read/imported.h"
#include "core/record/read/session_reader.h"
#include "experiments/studies/experiment.h"
#include "experiments/study/study_files.h"

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

}  // namespace haptrial::experiments
