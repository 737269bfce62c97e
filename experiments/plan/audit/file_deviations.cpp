#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>

#include "core/base/counted.h"
#include "core/base/error.h"
#include "core/base/stated_words.h"
#include "experiments/plan/audit/stated_and_done.h"
#include "protocols/definition/groups.h"

namespace haptrial::experiments {
namespace {

/// A session that was closed and whose file, as it was then, is not there.
struct ClosedSession {
  std::string begun;
  std::string sha256;
};

/// Closed sessions without those of participants who withdrew.
std::vector<ClosedSession> closed_sessions(const PlanLog& log) {
  std::vector<ClosedSession> closed;
  std::multiset<std::string> withdrawn;
  for (const PlanEntry& entry : log.entries) {
    const auto digests = entry.values("sha256");
    if (entry.what == kSessionClosed && !digests.empty()) {
      const auto begun = entry.values("begun");
      closed.push_back({begun.empty() ? "" : begun[0], digests[0]});
    } else if (entry.what == kWithdrawn) {
      withdrawn.insert(digests.begin(), digests.end());
    }
  }
  std::erase_if(closed, [&](const ClosedSession& each) {
    const auto at = withdrawn.find(each.sha256);
    return at != withdrawn.end() && (withdrawn.erase(at), true);
  });
  return closed;
}

/// Takes out the first that has a value. @returns whether there was one
bool take_first(std::vector<ClosedSession>& closed, std::string ClosedSession::*member,
                const std::string& value) {
  const auto at = std::ranges::find(closed, value, member);
  return at != closed.end() && (closed.erase(at), true);
}

}  // namespace

void add_files(const PlannedStudy& study, std::vector<Deviation>& deviations) {
  if (!study.log.broken.empty()) {
    deviations.push_back({"log_changed", study.log.broken});
  }
  std::vector<ClosedSession> closed = closed_sessions(study.log);
  std::vector<const SessionFacts*> unknown;
  for (const SessionFacts& each : study.sessions) {
    if (!take_first(closed, &ClosedSession::sha256, each.sha256)) {
      unknown.push_back(&each);
    }
  }
  for (const SessionFacts* each : unknown) {
    if (!each->unreadable.empty()) {
      deviations.push_back({"file_changed", fmt::format("{} cannot be read", each->name)});
    } else if (take_first(closed, &ClosedSession::begun, each->info.start_utc)) {
      deviations.push_back(
          {"file_changed", fmt::format("{} was changed after its session was closed", each->name)});
    } else if (each->info.start_utc >= study.plan.made_utc) {
      deviations.push_back(
          {"file_unknown", fmt::format("{} is no file of a session that was closed here: it "
                                       "replaces one, or comes from elsewhere",
                                       each->name)});
    }
  }
  for (const ClosedSession& each : closed) {
    deviations.push_back(
        {"file_missing",
         fmt::format("the file of the session that was begun at {} is not there", each.begun)});
  }
}

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
