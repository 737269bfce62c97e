#include "analysis/bone_drilling/report/session_files.h"

#include <fmt/format.h>

namespace haptrial::analysis::drilling {

std::vector<std::string> remarks_on_files(std::span<const SessionFiles> sessions) {
  std::map<std::pair<std::string, int>, const bone::BoneModel*> bones;
  std::vector<std::string> other_bones, other_limits;
  for (const SessionFiles& session : sessions) {
    bool differs = false;
    for (const auto& [procedure, bone] : session.bones) {
      differs |= bones.try_emplace(procedure, bone.get()).first->second != bone.get();
    }
    if (differs) {
      other_bones.push_back(session.session);
    }
    if (session.limits != sessions.front().limits) {
      other_limits.push_back(session.session);
    }
  }
  std::vector<std::string> remarks;
  if (!other_bones.empty()) {
    remarks.push_back(fmt::format(
        "Recorded on another bone than earlier sessions, although the definition names the same: "
        "{}. Their figures are not comparable.",
        fmt::join(other_bones, ", ")));
  }
  if (!other_limits.empty()) {
    remarks.push_back(fmt::format(
        "Recorded with other safe values of hints than {}, although the definition names the same "
        "file: {}. Their hints are not comparable.",
        sessions.front().session, fmt::join(other_limits, ", ")));
  }
  return remarks;
}

}  // namespace haptrial::analysis::drilling
