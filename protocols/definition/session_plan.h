#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/definition/schema_forward.h"

namespace haptrial::protocols {

/// One session of each participant as [design.session.N] states it, as far as all protocols have
/// it.
struct SessionPlan {
  std::string name{};                 // for reports and tests, "pre-test"; empty: its number
  std::vector<std::string> groups{};  // whose participants alone come; empty: everybody
  bool gives{true};  // the study gives what it does: training passes, hints, a tutor …
};

/// Reads the rest of a session's table, which belongs to a protocol. @param number  from 1
using ReadSession = std::function<void(Table& session, int number)>;

/// The sessions that [design.session.N] describes, of all sessions or of none; problems are noted.
/// @param sessions  of each participant >= 1
/// @param contents  what a session's table says at least, for a sentence: "its blocks"
std::vector<SessionPlan> read_session_plans(Table& root, int sessions, std::string_view contents,
                                            const ReadSession& read_more);

/// Notes groups that [groups] does not have, where a key names some.
void check_groups(Table& root, Table& table, std::string_view key,
                  const std::vector<std::string>& groups);

}  // namespace haptrial::protocols
