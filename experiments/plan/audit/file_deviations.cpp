#include <fmt/format.h>

#include <algorithm>

#include "experiments/plan/audit/stated_and_done.h"

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

}  // namespace haptrial::experiments
