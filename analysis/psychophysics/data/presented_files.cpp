#include "analysis/psychophysics/data/presented_files.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>

namespace haptrial::analysis::trials {
namespace {

/// A file as it was, and the sessions in which it was felt or heard.
struct PresentedFile {
  record::ObjectFileRow file;
  std::vector<std::string> sessions;
};

void add_file(const record::ObjectFileRow& file, const std::string& session,
              std::vector<PresentedFile>& presented) {
  const auto same = std::ranges::find_if(presented, [&](const PresentedFile& each) {
    return each.file.bytes == file.bytes && each.file.checksum == file.checksum;
  });
  if (same == presented.end()) {
    presented.push_back({file, {session}});
  } else {
    same->sessions.push_back(session);
  }
}

}  // namespace

std::vector<std::string> unlike_files(const std::vector<StudySession>& sessions) {
  std::map<std::string, std::vector<PresentedFile>> by_key;
  for (const StudySession& session : sessions) {
    for (const record::ObjectFileRow& file : session.files) {
      add_file(file, session.file, by_key[file.key()]);
    }
  }
  std::vector<std::string> sentences;
  for (const auto& [key, presented] : by_key) {
    if (presented.size() < 2) {
      continue;
    }
    std::vector<std::string> parts;
    for (const PresentedFile& each : presented) {
      parts.push_back(fmt::format("'{}' with the checksum {:016x} in {}", each.file.file,
                                  each.file.checksum, fmt::join(each.sessions, ", ")));
    }
    sentences.push_back(
        fmt::format("{} was not the same file in all sessions, which are analysed together all the "
                    "same: {}.",
                    key, fmt::join(parts, "; ")));
  }
  return sentences;
}

}  // namespace haptrial::analysis::trials
