#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "core/base/counted.h"
#include "core/base/error.h"
#include "core/base/stated_words.h"
#include "experiments/plan/audit/stated_and_done.h"
#include "protocols/definition/groups.h"

namespace haptrial::experiments {
namespace {

/// The group of a participant, or "" if the plan has none for the identifier.
std::string planned_group(const StudyPlan& plan, const std::string& subject) {
  std::vector<protocols::StudyGroup> groups;
  for (const PlannedGroup& group : plan.groups) {
    groups.push_back({group.name, group.participants, false, group.participants});
  }
  try {
    return plan.groups.size() > 1 ? protocols::group_of(groups, subject) : "";
  } catch (const InputError&) {
    return "";
  }
}

void compare_people(const std::string& where, int planned, int done,
                    std::vector<Deviation>& deviations) {
  if (done != planned) {
    deviations.push_back({done < planned ? "people_missing" : "people_extra",
                          fmt::format("{}{} took part, {} {} stated", where,
                                      counted(done, "participant", "participants"), planned,
                                      planned == 1 ? "was" : "were")});
  }
}

void add_sessions(const PlannedStudy& study, std::vector<Deviation>& deviations) {
  for (const auto& [subject, had] : sessions_had(study.sessions)) {
    const int planned = sessions_of(study.plan, subject);
    if (static_cast<int>(had.size()) < planned) {
      deviations.push_back({"sessions_missing",
                            fmt::format("{} has {} of {} sessions", subject, had.size(), planned)});
    }
  }
}

bool is_stated(const StudyPlan& plan, const std::vector<std::string>& reasons) {
  return std::ranges::any_of(reasons, [&](const std::string& reason) {
    return std::ranges::any_of(plan.exclusions, [&](const std::string& stated) {
      return has_stated_word(reason, stated);
    });
  });
}

}  // namespace

int sessions_of(const StudyPlan& plan, const std::string& subject) {
  const auto group =
      std::ranges::find(plan.groups, planned_group(plan, subject), &PlannedGroup::name);
  return group != plan.groups.end() ? group->sessions : plan.sessions;
}

void add_people(const PlannedStudy& study, std::vector<Deviation>& deviations) {
  const auto had = sessions_had(study.sessions);
  const StudyPlan& plan = study.plan;
  int in_groups = 0;
  if (study.ended) {
    compare_people(fmt::format("the study ended by its rule after {}: ", *study.ended),
                   *study.ended, static_cast<int>(had.size()), deviations);
  } else if (plan.groups.size() > 1) {
    for (const PlannedGroup& group : plan.groups) {
      const auto done = static_cast<int>(std::ranges::count_if(
          had, [&](const auto& each) { return planned_group(plan, each.first) == group.name; }));
      in_groups += done;
      compare_people("group " + group.name + ": ", group.participants, done, deviations);
    }
    compare_people("without a group: ", 0, static_cast<int>(had.size()) - in_groups, deviations);
  } else {
    compare_people("", plan.participants(), static_cast<int>(had.size()), deviations);
  }
  add_sessions(study, deviations);
}

void add_exclusions(const PlannedStudy& study, std::vector<Deviation>& deviations) {
  std::set<std::string> excluded;
  for (const SessionFacts& each : study.sessions) {
    if (each.excluded && each.unreadable.empty()) {
      excluded.insert(each.info.subject);
    }
  }
  for (const std::string& subject : excluded) {
    const auto reasons = study.reasons.find(subject);
    if (reasons == study.reasons.end()) {
      deviations.push_back(
          {"exclusion_not_stated", fmt::format("{} was excluded without a reason", subject)});
    } else if (!is_stated(study.plan, reasons->second)) {
      deviations.push_back({"exclusion_not_stated",
                            fmt::format("{} was excluded for \"{}\", which is no stated reason",
                                        subject, fmt::join(reasons->second, "; "))});
    }
  }
}

void add_trials(const PlannedStudy& study, std::vector<Deviation>& deviations) {
  for (const SessionFacts& each : study.sessions) {
    if (!each.counts()) {
      continue;
    }
    std::vector<std::string> why;
    const record::TrialProgress& p = each.progress;
    if (p.skipped > 0) {
      why.push_back(fmt::format("{} skipped", p.skipped));
    }
    if (p.aborted > 0) {
      why.push_back(fmt::format("{} aborted", p.aborted));
    }
    if (!p.ended_early.empty()) {
      why.push_back("ended with trials left, " + p.ended_early);
    }
    for (const std::string& event : each.plan_events) {
      for (const std::string& first : values_in(event, "first_trials")) {
        why.push_back(fmt::format("begun for the first {} alone", first));
      }
    }
    if (!why.empty()) {
      deviations.push_back({"trials_dropped",
                            fmt::format("{}: {} done; {}", each.name,
                                        counted(p.done, "trial", "trials"), fmt::join(why, "; "))});
    }
  }
}

}  // namespace haptrial::experiments
