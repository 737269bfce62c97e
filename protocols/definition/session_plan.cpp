#include "protocols/definition/session_plan.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>

#include "core/base/definition/schema.h"

namespace haptrial::protocols {
namespace {

const Schema<SessionPlan>& session_plan_schema() {
  using P = SessionPlan;
  static const auto schema =
      Schema<P>()
          .text("name", &P::name, "Name of the session in reports and planned tests")
          .otherwise("its number")
          .texts("groups", &P::groups, "Groups whose participants alone come to the session")
          .otherwise("all")
          .flag("gives", &P::gives,
                "Whether the session gives what the study gives: training passes, hints, nerve "
                "monitor, forbidden regions, a tutor; a test gives nothing");
  return schema;
}

/// Tests and tables tell sessions apart by their names.
void check_names(Table& design, const std::vector<SessionPlan>& plans) {
  std::set<std::string> names;
  for (std::size_t i = 0; i < plans.size(); ++i) {
    const std::string name = plans[i].name.empty() ? std::to_string(i + 1) : plans[i].name;
    if (!names.insert(name).second) {
      design.reject(
          "session",
          fmt::format("has two sessions called \"{}\"; give each a name of its own", name));
    }
  }
}

}  // namespace

void check_groups(Table& root, Table& table, std::string_view key,
                  const std::vector<std::string>& groups) {
  const std::vector<std::string> known =
      root.has("groups") ? root.table("groups").keys_as_written() : std::vector<std::string>{};
  for (const std::string& group : groups) {
    if (std::ranges::find(known, group) == known.end()) {
      table.reject(key, fmt::format("an array with \"{}\"", group),
                   known.empty() ? "groups of a table [groups], which is not there"
                                 : fmt::format("groups: {}", fmt::join(known, ", ")));
    }
  }
}

std::vector<SessionPlan> read_session_plans(Table& root, int sessions, std::string_view contents,
                                            const ReadSession& read_more) {
  Table design = root.table("design");
  std::vector<SessionPlan> plans;
  if (!design.has("session")) {
    return plans;
  }
  Table table = design.table("session");
  for (int session = 1; session <= sessions; ++session) {
    const std::string number = std::to_string(session);
    SessionPlan& plan = plans.emplace_back();
    if (!table.has(number)) {
      design.reject("session", fmt::format("says nothing of session {0}; add [design.session.{0}] "
                                           "with {1}",
                                           number, contents));
      continue;
    }
    Table one = table.table(number);
    session_plan_schema().read(one, plan);
    check_groups(root, one, "groups", plan.groups);
    read_more(one, session);
  }
  check_names(design, plans);
  return plans;
}

}  // namespace haptrial::protocols
