#include "analysis/exchange/data_set_sessions.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "analysis/exchange/pass_facts.h"
#include "analysis/files/new_folder.h"
#include "core/base/error.h"
#include "core/record/read/definition_versions.h"
#include "core/record/read/session_reader.h"

namespace haptrial::exchange {

namespace fs = std::filesystem;
using bids::Session;

namespace {

std::string label_of(const std::string& what, const std::string& text, const fs::path& file) {
  const std::string label = bids_label(text);
  if (label.empty()) {
    throw InputError(fmt::format(
        "{}: the {} '{}' has no ASCII letter or digit, which a label of the data set needs; "
        "choose another name",
        file.string(), what, text));
  }
  return label;
}

/// The label of the experiment's name, or of its file's when the name has no letter or digit of
/// ASCII.
std::string task_of(const ExportSession& session) {
  const std::string label = bids_label(experiment_name(session.info));
  const fs::path file(session.info.definition_name);
  return label.empty() ? label_of("experiment", file.stem().string(), session.file) : label;
}

void refuse_other_study(const ExportSession& session, const ExportSession& first,
                        const CompareDefinitions& compare) {
  const DefinitionChanges changes =
      compare ? compare(first.info, session.info)
              : definition_changes(first.info.definition, session.info.definition, {});
  if (!changes.same_study()) {
    throw InputError(
        fmt::format("{}: was recorded with another definition than {}: {}; export each study into "
                    "a folder of its own",
                    session.file.string(), first.file.string(), sentence_of(changes.binding)));
  }
}

}  // namespace

std::vector<Session> data_set_sessions(std::span<const fs::path> files,
                                       const CompareDefinitions& compare) {
  std::vector<Session> sessions;
  std::map<std::string, std::string> subjects;  // label to subject
  const std::vector<ExportSession> sources = sessions_to_export(files);
  const bool several =
      std::any_of(sources.begin(), sources.end(), [](const auto& s) { return s.of > 1; });
  for (const auto& source : sources) {
    refuse_other_study(source, sources.front(), compare);
    const std::string label = label_of("subject", source.info.subject, source.file);
    const auto [twin, is_new] = subjects.emplace(label, source.info.subject);
    if (!is_new && twin->second != source.info.subject) {
      throw InputError(
          fmt::format("{}: subject {} would be sub-{}, like {}; choose subjects that differ in "
                      "their letters and digits",
                      source.file.string(), source.info.subject, label, twin->second));
    }
    sessions.push_back({source, "sub-" + label, several ? fmt::format("ses-{}", source.number) : "",
                        task_of(source)});
  }
  return sessions;
}

std::vector<ColumnDoc> fact_columns(std::span<const Session> sessions) {
  std::vector<ColumnDoc> columns;
  for (const Session& session : sessions) {
    merge_columns(pass_facts(record::SessionReader(session.source.file)).columns, columns);
  }
  return columns;
}

void write_definitions(const NewFolder& out, std::span<const Session> sessions,
                       const std::string& folder) {
  const std::string stem = folder + "/" + sessions.front().task;
  std::set<std::string> written;
  for (const Session& session : sessions) {
    const record::SessionReader reader(session.source.file);
    for (const auto& version : record::definition_versions(reader)) {
      if (written.insert(version.text).second) {
        const std::string number = written.size() > 1 ? fmt::format("-{}", written.size()) : "";
        out.write(stem + number + ".toml", version.text);
      }
    }
  }
}

}  // namespace haptrial::exchange
