#include "experiments/study/study_definitions.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <map>

#include "core/base/error.h"
#include "core/record/read/definition_versions.h"
#include "core/record/read/session_reader.h"
#include "protocols/interface/study_rules.h"

namespace haptrial::experiments {
namespace {

namespace fs = std::filesystem;
using record::DefinitionVersion;

std::string words(const DefinitionChanges& changes) {
  return changes.free.empty() ? "only comments, layout or order differ"
                              : sentence_of(changes.free) + "; such keys may change within a study";
}

/// " from trial 5 on"; empty if no pass follows.
std::string since(const DefinitionVersion& version) {
  if (!version.first) {
    return "";
  }
  return version.first->practice ? " from the practice trials on"
                                 : fmt::format(" from trial {} on", version.first->trial);
}

void refuse_other(const DefinitionChanges& changes, const fs::path& file, const fs::path& first) {
  if (!changes.same_study()) {
    throw InputError(
        fmt::format("{}: was recorded with another definition than {}: {}; analyse each study in a "
                    "folder of its own",
                    file.string(), first.string(), sentence_of(changes.binding)));
  }
}

}  // namespace

std::vector<std::string> definition_remarks(const protocols::Protocol& protocol,
                                            const std::vector<fs::path>& files) {
  const record::SessionInfo first = record::SessionReader(files.front()).info();
  std::map<std::string, std::vector<std::string>> recorded;  // what differs, the files
  std::vector<std::string> resumed;
  for (const fs::path& file : files) {
    const record::SessionReader reader(file);
    const std::string name = file.filename().string();
    const std::string* before = nullptr;
    const auto versions = record::definition_versions(reader);
    for (const DefinitionVersion& version : versions) {
      record::SessionInfo info = reader.info();
      info.definition = version.text;
      const DefinitionChanges of_study = protocols::study_changes(protocol, first, info);
      refuse_other(of_study, file, files.front());
      if (before == nullptr && !of_study.same_text) {
        recorded[words(of_study)].push_back(name);
      } else if (before != nullptr) {
        info.definition = *before;
        resumed.push_back(fmt::format(
            "{} was resumed with a changed definition{}: {}.", name, since(version),
            words(protocols::study_changes(protocol, info, version.text, info.device))));
      }
      before = &version.text;
    }
  }
  std::vector<std::string> remarks;
  for (const auto& [what, names] : recorded) {
    remarks.push_back(fmt::format("{} {} recorded with a changed definition: {}.",
                                  fmt::join(names, ", "), names.size() > 1 ? "were" : "was", what));
  }
  remarks.insert(remarks.end(), resumed.begin(), resumed.end());
  return remarks;
}

}  // namespace haptrial::experiments
