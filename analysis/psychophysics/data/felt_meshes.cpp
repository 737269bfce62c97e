#include "analysis/psychophysics/data/felt_meshes.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>

namespace haptrial::analysis::trials {
namespace {

/// A mesh file as it was, and the sessions in which it was felt.
struct HapticMesh {
  record::ObjectFileRow file;
  std::vector<std::string> sessions;
};

void add_mesh(const record::ObjectFileRow& file, const std::string& session,
              std::vector<HapticMesh>& felt) {
  const auto same = std::ranges::find_if(felt, [&](const HapticMesh& mesh) {
    return mesh.file.bytes == file.bytes && mesh.file.checksum == file.checksum;
  });
  if (same == felt.end()) {
    felt.push_back({file, {session}});
  } else {
    same->sessions.push_back(session);
  }
}

}  // namespace

std::vector<std::string> unlike_meshes(const std::vector<StudySession>& sessions) {
  std::map<std::string, std::vector<HapticMesh>> by_object;
  for (const StudySession& session : sessions) {
    for (const record::ObjectFileRow& file : session.meshes) {
      add_mesh(file, session.file, by_object[file.name]);
    }
  }
  std::vector<std::string> sentences;
  for (const auto& [name, felt] : by_object) {
    if (felt.size() < 2) {
      continue;
    }
    std::vector<std::string> parts;
    for (const HapticMesh& mesh : felt) {
      parts.push_back(fmt::format("'{}' with the checksum {:016x} in {}", mesh.file.file,
                                  mesh.file.checksum, fmt::join(mesh.sessions, ", ")));
    }
    sentences.push_back(
        fmt::format("objects.{} was not the same mesh in all sessions, which are analysed together "
                    "all the same: {}.",
                    name, fmt::join(parts, "; ")));
  }
  return sentences;
}

}  // namespace haptrial::analysis::trials
