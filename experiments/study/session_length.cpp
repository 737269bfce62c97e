#include "experiments/study/session_length.h"

#include <algorithm>

#include "experiments/study/roster.h"
#include "protocols/definition/definition.h"

namespace haptrial::experiments {

double session_seconds(const protocols::Definition& d, int trials) {
  const int breaks = d.design.break_after > 0 ? (trials - 1) / d.design.break_after : 0;
  return d.longest(trials) + breaks * d.design.break_duration;
}

/// How many sessions the participants of a group come to.
static int sessions_of(const Roster& roster, const std::string& group) {
  const auto at = std::ranges::find(roster.groups, group, &RosterGroup::name);
  return at != roster.groups.end() ? at->sessions : roster.sessions;
}

int sessions_to_come(const Roster& roster) {
  int planned = 0;
  for (const RosterGroup& group : roster.groups) {
    planned += group.planned * group.sessions;
  }
  int had = 0;
  for (const RosterPerson& person : roster.persons) {
    if (person.pilot || person.excluded || person.never_took_part()) {
      continue;
    }
    if (person.declined() || person.next == 0) {
      had += sessions_of(roster, person.group);  // nothing more is to be run
      continue;
    }
    had += static_cast<int>(std::ranges::count_if(person.sessions, [](const RosterSession& each) {
      return each.state == SessionState::kDone || each.state == SessionState::kAborted;
    }));
  }
  return std::max(0, planned - had);
}

}  // namespace haptrial::experiments
