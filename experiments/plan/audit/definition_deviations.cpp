#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <span>

#include "analysis/files/sha256.h"
#include "core/base/counted.h"
#include "experiments/plan/audit/stated_and_done.h"
#include "experiments/runner/version.h"
#include "experiments/studies/registry.h"
#include "protocols/interface/study_rules.h"

namespace haptrial::experiments {
namespace {

bool before_plan(const PlannedStudy& study, const SessionFacts& session) {
  return session.info.start_utc < study.plan.made_utc;
}

/// Sentences that the same holds of several files are said once.
using FilesBySentence = std::map<std::string, std::vector<std::string>>;

void add_sentences(const char* kind, const FilesBySentence& found,
                   std::vector<Deviation>& deviations) {
  for (const auto& [sentence, files] : found) {
    std::vector<std::string> names = files;
    names.erase(std::unique(names.begin(), names.end()), names.end());
    deviations.push_back({kind, fmt::format("{}: {}", fmt::join(names, ", "), sentence)});
  }
}

std::string program_of(const record::SessionInfo& info) {
  return fmt::format("haptrial {} ({})", info.program_version, info.program_commit);
}

bool is_session(const PlanEntry& entry) { return entry.what == kSessionClosed; }

/// Participants with every session at an analysis.
int people_at(const PlannedStudy& study, std::size_t analysis) {
  const auto people = study.log.entries[analysis].values("people");
  return people.empty() ? study.plan.participants() : std::atoi(people[0].c_str());
}

/// Analyses that the plan does not state as looks at the data, by their place in the log.
std::vector<std::size_t> unstated_analyses(const PlannedStudy& study) {
  if (study.plan.ends_early == kAtAnyTime) {
    return {};
  }
  std::vector<std::size_t> unstated = seen_analyses(study.log);
  std::erase_if(unstated, [&](std::size_t at) {
    return std::ranges::find(study.plan.looks, people_at(study, at)) != study.plan.looks.end();
  });
  return unstated;
}

/// People of whom data had been analysed, and how often, before the last session that the plan
/// states or another one after that; stated looks are left out.
std::map<int, std::vector<const PlanEntry*>> early_looks(const PlannedStudy& study) {
  std::map<int, std::vector<const PlanEntry*>> looks;
  const std::span all = study.log.entries;
  for (const std::size_t at : unstated_analyses(study)) {
    const int count = people_at(study, at);
    const auto closed = std::ranges::count_if(all.first(at), is_session);
    const bool complete = closed >= study.plan.participants() * study.plan.sessions;
    const bool early = count < study.plan.participants() && !complete;
    if (early || std::ranges::any_of(all.subspan(at), is_session)) {
      looks[count].push_back(&all[at]);
    }
  }
  return looks;
}

/// People who were excluded when the result was known.
void add_late_exclusions(const PlannedStudy& study, std::vector<Deviation>& deviations) {
  const std::vector<std::size_t> seen = unstated_analyses(study);
  if (seen.empty()) {
    return;
  }
  const std::span all = study.log.entries;
  for (const PlanEntry& entry : all.subspan(seen.front())) {
    if (entry.what == kExcluded) {
      deviations.push_back(
          {"excluded_late",
           fmt::format("somebody was excluded by {} at {}, after the data had been "
                       "analysed at {}",
                       entry.login, entry.time, all[seen.front()].time)});
    }
  }
}

}  // namespace

void add_definitions(const PlannedStudy& study, std::vector<Deviation>& deviations) {
  FilesBySentence found;
  for (const SessionFacts& each : study.sessions) {
    for (const std::string& text : each.counts() ? each.definitions : std::vector<std::string>()) {
      record::SessionInfo planned = each.info, session = each.info;
      planned.definition = study.plan.definition;
      session.definition = text;
      const auto changes = protocols::study_changes(protocol_of(each.info), planned, session);
      for (const auto* list : {&changes.binding, &changes.free}) {
        for (const DefinitionChange& change : *list) {
          found[sentence_of({change})].push_back(each.name);
        }
      }
    }
  }
  for (const SessionFacts& each : study.sessions) {
    for (const std::string& text : each.counts() ? each.scripts : std::vector<std::string>()) {
      const std::string sha256 = analysis::sha256_of(text);
      if (sha256 != study.plan.scripts_sha256) {
        found[fmt::format("the script of levels was another one (SHA-256 {}), the plan states {}",
                          sha256,
                          study.plan.scripts_sha256.empty() ? "none" : study.plan.scripts_sha256)]
            .push_back(each.name);
      }
    }
  }
  add_sentences("definition_changed", found, deviations);
}

void add_programs(const PlannedStudy& study, std::vector<Deviation>& deviations) {
  FilesBySentence found;
  for (const SessionFacts& each : study.sessions) {
    if (each.counts() && program_of(each.info) != study.plan.program) {
      found[fmt::format("recorded by {}, the plan states {}", program_of(each.info),
                        study.plan.program)]
          .push_back(each.name);
    }
  }
  add_sentences("program_changed", found, deviations);
  const std::string now = fmt::format("haptrial {} ({})", program_version(), program_commit());
  if (now != study.plan.program) {
    deviations.push_back({"program_changed", fmt::format("analysed by {}, the plan states {}", now,
                                                         study.plan.program)});
  }
}

void add_analyses(const PlannedStudy& study, std::vector<Deviation>& deviations) {
  for (const auto& [people, entries] : early_looks(study)) {
    deviations.push_back(
        {"looked_at_data",
         fmt::format("the data of {} of {} participants with every session was analysed {} before "
                     "the last session, first by {} at {}",
                     people, study.plan.participants(), counted(entries.size(), "time", "times"),
                     entries.front()->login, entries.front()->time)});
  }
  add_late_exclusions(study, deviations);
  std::set<std::string> given;
  for (const std::size_t at : seen_analyses(study.log)) {
    for (const std::string& tests : study.log.entries[at].values("tests")) {
      if (tests != "definition") {
        given.insert(tests);
      }
    }
  }
  for (const std::string& tests : given) {
    deviations.push_back(
        {"tests_changed",
         fmt::format("an analysis was given other tests than the plan's: {}", tests)});
  }
}

void add_plans_of_sessions(const PlannedStudy& study, std::vector<Deviation>& deviations) {
  std::set<std::string> links{study.plan.sha256};
  for (const PlanEntry& entry : study.log.entries) {
    links.insert(entry.link);
  }
  for (const SessionFacts& each : study.sessions) {
    if (!each.unreadable.empty() || each.info.pilot) {
      continue;
    }
    if (before_plan(study, each)) {
      deviations.push_back({"before_plan", fmt::format("{} was begun at {}, before the plan",
                                                       each.name, each.info.start_utc)});
    } else if (each.plan_events.empty()) {
      deviations.push_back({"without_plan", each.name + " was recorded without the plan"});
    }
    for (const std::string& event : each.plan_events) {
      if (values_in(event, "plan") != std::vector{study.plan.sha256}) {
        deviations.push_back({"another_plan", each.name + " was recorded with another plan"});
      } else if (const auto at = values_in(event, "link"); at.empty() || !links.contains(at[0])) {
        deviations.push_back({"log_cut", fmt::format("{} was recorded when the log had a line that "
                                                     "it has no more",
                                                     each.name)});
      }
    }
  }
}

}  // namespace haptrial::experiments
