#include "experiments/plan/audit/stated_and_done.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "analysis/exchange/own_findings.h"
#include "analysis/files/sha256.h"
#include "core/base/counted.h"
#include "core/base/error.h"
#include "experiments/studies/registry.h"

namespace haptrial::experiments {
namespace {

namespace fs = std::filesystem;
using analysis::Finding;

std::string list_of(const std::vector<std::string>& texts, const char* none) {
  return texts.empty() ? none : fmt::format("{}", fmt::join(texts, "; "));
}

/// People who had every session.
int complete_people(const StudyPlan& plan, const std::vector<SessionFacts>& sessions) {
  const auto had = sessions_had(sessions);
  return static_cast<int>(std::ranges::count_if(had, [&](const auto& each) {
    return static_cast<int>(each.second.size()) >= sessions_of(plan, each.first);
  }));
}

std::string exclusions_done(const PlannedStudy& study) {
  std::vector<std::string> all;
  for (const auto& [subject, reasons] : study.reasons) {
    all.push_back(fmt::format("{}: {}", subject, fmt::join(reasons, "; ")));
  }
  return list_of(all, "nobody");
}

/// Participants after whom the rule of the sessions' definition ended the study, decided or with as
/// many as may come; nothing if it goes on, or if too few have come to say so.
std::optional<int> ended_after(const fs::path& folder) {
  AnalysisRequest request;
  request.folder = folder;
  try {
    request.files = study_files(folder, Pilots::kLeftOut, protocol_of);
    const auto result = study_of(request.files.first).sequential(request);
    if (!result || result->verdict == analysis::SequentialVerdict::kGoOn) {
      return std::nullopt;
    }
    return static_cast<int>(result->verdict == analysis::SequentialVerdict::kUndecided
                                ? result->most
                                : result->looks.back().participants);
  } catch (const InputError&) {
    return std::nullopt;
  }
}

std::string looks_stated(const StudyPlan& plan) {
  if (plan.ends_early == kAtAnyTime) {
    return "after any participant";
  }
  return plan.looks.empty()
             ? "at the end"
             : fmt::format("with {} participants, and at the end", fmt::join(plan.looks, ", "));
}

std::string analyses_done(const PlannedStudy& study) {
  std::vector<std::string> all;
  for (const std::size_t at : seen_analyses(study.log)) {
    if (const auto people = study.log.entries[at].values("people"); !people.empty()) {
      all.push_back(people[0]);
    }
  }
  return all.empty() ? "none" : fmt::format("with {} participants", fmt::join(all, ", "));
}

std::string withdrawals(const PlannedStudy& study) {
  const auto count = std::ranges::count(study.log.entries, kWithdrawn, &PlanEntry::what);
  return count == 0 ? "" : fmt::format("; {} withdrew", count);
}

int trials_done(const PlannedStudy& study) {
  int done = 0;
  for (const SessionFacts& each : study.sessions) {
    done += each.counts() ? each.progress.done : 0;
  }
  return done;
}

analysis::FindingRow row(const std::string& what, const std::string& stated,
                         const std::string& done) {
  return {{.name = "what", .title = "what", .value = what},
          {.name = "stated", .title = "stated", .value = stated},
          {.name = "done", .title = "done", .value = done}};
}

analysis::FindingTable comparison(const PlannedStudy& study) {
  const StudyPlan& plan = study.plan;
  analysis::FindingTable table{.name = "stated_and_done", .title = "Plan and study"};
  table.rows = {
      row("participants", std::to_string(plan.participants()),
          fmt::format(
              "{} with every session, {} in all{}{}", complete_people(plan, study.sessions),
              sessions_had(study.sessions).size(), withdrawals(study),
              study.ended ? fmt::format("; ended by its rule after {}", *study.ended) : "")),
      row("sessions of each", std::to_string(plan.sessions),
          fmt::format("{}, {} done",
                      counted(std::ranges::count_if(study.sessions, &SessionFacts::counts),
                              "session", "sessions"),
                      counted(trials_done(study), "trial", "trials"))),
      row("hypotheses", list_of(plan.hypotheses, "none"), "below"),
      row("planned tests", list_of(plan.tests, "those of the definition's analysis"), "below"),
      row("exclusions", list_of(plan.exclusions, "nobody"), exclusions_done(study)),
      row("end", plan.stopping, "below"),
      row("analyses", looks_stated(plan), analyses_done(study)),
      row("power", list_of(plan.power, "not stated"), "not computed from the data")};
  return table;
}

analysis::FindingTable deviation_table(const std::vector<Deviation>& deviations) {
  analysis::FindingTable table{
      .name = "deviations", .title = "Deviations from the plan", .in_lines = true};
  for (const Deviation& each : deviations) {
    table.rows.push_back({{.name = "kind", .title = "kind", .value = each.kind},
                          {.name = "what", .title = "deviation", .value = each.what}});
  }
  return table;
}

analysis::FindingList findings_of(const PlannedStudy& study) {
  const std::vector<Deviation> deviations = deviations_of(study);
  analysis::FindingList list{.name = "stated_and_done", .heading = "Stated and done"};
  list.opens = true;
  list.findings = {
      {.name = "plan/made_utc", .title = "Plan made at", .value = study.plan.made_utc},
      {.name = "plan/sha256", .title = "Plan, SHA-256", .value = study.plan.sha256},
      {.name = "log/head", .title = "Last line of its log, SHA-256", .value = study.log.head},
      {.name = "log/lines", .title = "Lines of its log", .value = study.log.entries.size()},
      {.name = "deviations", .title = "Deviations from the plan", .value = deviations.size()}};
  if (!deviations.empty()) {
    list.tables.push_back(deviation_table(deviations));
  }
  list.tables.push_back(comparison(study));
  return list;
}

}  // namespace

PlannedStudy planned_study(const fs::path& plan) {
  const fs::path folder = plan.parent_path();
  PlannedStudy study{read_study_plan(plan), read_plan_log(plan), session_facts(folder),
                     exclusion_reasons(folder)};
  for (SessionFacts& each : study.sessions) {
    each.sha256 = analysis::sha256_of_file(each.file);
  }
  if (!study.plan.ends_early.empty()) {
    study.ended = ended_after(folder);
  }
  return study;
}

std::vector<Deviation> deviations_of(const PlannedStudy& study) {
  std::vector<Deviation> all;
  for (const auto add : {add_people, add_trials, add_exclusions, add_definitions, add_programs,
                         add_analyses, add_plans_of_sessions, add_files}) {
    add(study, all);
  }
  return all;
}

analysis::FindingList stated_and_done(const std::vector<fs::path>& sessions) {
  if (sessions.empty()) {
    return {};
  }
  const auto plan = plan_in(sessions.front().parent_path());
  return plan ? findings_of(planned_study(*plan)) : analysis::FindingList{};
}

void add_stated_and_done() {
  static const bool added =
      (analysis::add_finding_source({"stated_and_done", stated_and_done}), true);
  static_cast<void>(added);
}

void note_analysis(const fs::path& folder, const std::vector<std::string>& given) {
  const auto plan = plan_in(folder);
  if (!plan) {
    return;
  }
  note_in_log(
      *plan, kAnalysed,
      fmt::format("people={} tests={}",
                  complete_people(read_study_plan(*plan), session_facts(folder)),
                  given.empty() ? "definition" : fmt::format("{}", fmt::join(given, "; "))));
}

void note_failed_analysis(const fs::path& folder) {
  if (const auto plan = plan_in(folder)) {
    note_in_log(*plan, kAnalysisFailed, "");
  }
}

}  // namespace haptrial::experiments
