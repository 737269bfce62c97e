#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

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

/// People of whom data had been analysed, and how often; analyses of the whole sample and stated
/// ones are left out.
std::map<int, std::vector<const PlanEntry*>> early_looks(const PlannedStudy& study) {
  std::map<int, std::vector<const PlanEntry*>> looks;
  if (study.plan.ends_early == kAtAnyTime) {
    return looks;
  }
  for (const PlanEntry& entry : study.log.entries) {
    const auto people =
        entry.what == kAnalysed ? entry.values("people") : std::vector<std::string>();
    const int count = people.empty() ? study.plan.participants() : std::atoi(people[0].c_str());
    if (count < study.plan.participants() &&
        std::ranges::find(study.plan.looks, count) == study.plan.looks.end()) {
      looks[count].push_back(&entry);
    }
  }
  return looks;
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
         fmt::format("the data of {} of {} participants with every session was analysed {}, first "
                     "by {} at {}",
                     people, study.plan.participants(), counted(entries.size(), "time", "times"),
                     entries.front()->login, entries.front()->time)});
  }
  std::set<std::string> given;
  for (const PlanEntry& entry : study.log.entries) {
    for (const std::string& tests : entry.values("tests")) {
      if (entry.what == kAnalysed && tests != "definition") {
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
