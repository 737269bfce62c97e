#include <fmt/format.h>
#include <stdlib.h>  // mkdtemp
#include <unistd.h>

#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <sstream>
#include <utility>

#include "core/base/error.h"
#include "core/base/file_text.h"
#include "core/base/utf8.h"
#include "experiments/studio/views_internal.h"

namespace haptrial::experiments {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr std::uintmax_t kMostFile = 100'000'000;

/// A word that a command cannot take for an option or a path.
void check_word(const char* what, const std::string& word) {
  static const std::regex kWord("[A-Za-z0-9_][A-Za-z0-9_-]{0,99}");
  if (!std::regex_match(word, kWord)) {
    throw InputError(fmt::format(
        "{} is not a plain word; allowed: up to 100 letters A to Z, digits, '_' and '-'", what));
  }
}

/// Rows of three columns that two or more spaces part, as lists of commands have them.
json rows_of(const std::string& output) {
  static const std::regex kRow(R"((\S.*?)\s{2,}(\S.*?)\s{2,}(.+))");
  json rows = json::array();
  std::istringstream lines(output);
  for (std::string line; std::getline(lines, line);) {
    if (std::smatch parts; std::regex_match(line, parts, kRow)) {
      rows.push_back({parts.str(1), parts.str(2), parts.str(3)});
    }
  }
  return rows;
}

/// The rest of the first line that begins so; empty: there is none.
std::string line_after(const std::string& output, const std::string& start) {
  std::istringstream lines(output);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with(start)) {
      return line.substr(start.size());
    }
  }
  return "";
}

json remarks_json(const std::vector<Remark>& remarks) {
  json all = json::array();
  for (const Remark& remark : remarks) {
    all.push_back({{"mistake", remark.is_mistake},
                   {"line", remark.line},
                   {"column", remark.column},
                   {"text", remark.text}});
  }
  return all;
}

json lines_that_begin(const std::string& output, std::string_view with) {
  json all = json::array();
  std::istringstream lines(output);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with(with)) {
      all.push_back(line);
    }
  }
  return all;
}

json files_json(const std::vector<FolderFile>& files) {
  json all = json::array();
  for (const FolderFile& file : files) {
    all.push_back({{"name", file.name}, {"bytes", file.bytes}, {"modified", file.modified}});
  }
  return all;
}

/// The sessions but those that the roster calls pilots, which are no part of the study.
SessionFolder without_pilots(SessionFolder held, const json& study) {
  for (const json& person : study.value("/roster/participants"_json_pointer, json::array())) {
    for (const json& session : person["pilot"] == true ? person["sessions"] : json::array()) {
      for (std::vector<FolderFile>* files : {&held.sessions, &held.unfinished}) {
        std::erase_if(*files, [&](const FolderFile& file) { return session["file"] == file.name; });
      }
    }
  }
  return held;
}

}  // namespace

StudioViews::StudioViews(const StudyFolder& folder, Commands& commands, LineCommands& tried,
                         LineCommands& page_maker, fs::path libraries)
    : folder_(folder),
      commands_(commands),
      tried_(tried),
      page_maker_(page_maker),
      libraries_(std::move(libraries)) {
  std::error_code error;
  const fs::path temporary = fs::temp_directory_path(error);
  if (error) {
    throw RunError("the folder for temporary files, which TMPDIR names, is not there");
  }
  std::string name = (temporary / "haptrial-studio-XXXXXX").string();
  if (::mkdtemp(name.data()) == nullptr) {
    throw RunError(fmt::format("{}: no folder can be made there", temporary.string()));
  }
  scratch_ = name;
}

StudioViews::~StudioViews() {
  std::error_code ignored;
  fs::remove_all(scratch_, ignored);
}

CommandResult StudioViews::run_good(const CommandWords& words) const {
  CommandResult result = commands_.run(words);
  if (result.status != 0) {
    throw InputError(fmt::format("{}: {}", shown_command(words), result.output));
  }
  return result;
}

SessionFolder StudioViews::held_in(const std::string& name) const {
  return folder_.holds(name) ? list_sessions(folder_.path() / name) : SessionFolder();
}

json StudioViews::studies() const {
  return {{"folder", folder_.path().string()}, {"files", folder_.definitions()}};
}

json StudioViews::study(const std::string& file) const {
  folder_.definition(file);
  const CommandWords words{"validate", file};
  const CommandResult checked = commands_.run(words);
  const std::vector<Remark> remarks = read_remarks(checked.output, file, checked.status == 0);
  json out{{"command", shown_command(words)},
           {"valid", checked.status == 0},
           {"remarks", remarks_json(remarks)}};
  const std::string sessions = StudyFolder::sessions_of(file);
  const SessionFolder held = held_in(sessions);
  out["sessions"] = held.sessions.size();
  out["report"] = !held.report ? "none" : held.report_is_old ? "old" : "current";
  if (checked.status == 0) {
    add_roster(file, out);
  }
  const SessionFolder of_study = without_pilots(held, out);
  if (const FolderFile* newest = of_study.newest_session()) {
    add_last_event(sessions + "/" + newest->name, out);
  }
  return out;
}

/// How many of how many participants are done, and who is next.
void StudioViews::add_roster(const std::string& file, json& out) const {
  const ShortLivedFile written(scratch_ / fmt::format("roster-{}.json", next_number()));
  const CommandWords words{"roster", file, StudyFolder::sessions_of(file)};
  CommandWords asked = words;
  asked.insert(asked.end(), {"--json", written.path().string()});
  const CommandResult result = commands_.run(asked);
  const json roster =
      result.status == 0 ? json::parse(file_text(written.path()), nullptr, false) : json();
  if (!roster.is_object()) {
    out["roster"] = {{"command", shown_command(words)}, {"failure", result.output}};
    return;
  }
  out["roster"] = {
      {"command", shown_command(words)}, {"groups", roster["groups"]},
      {"next", roster["next"]},          {"participants", roster["participants"]},
      {"remarks", roster["remarks"]},    {"to_come", line_after(result.output, "to come: ")}};
}

/// The last abort, alarm or loss that the newest session tells of.
void StudioViews::add_last_event(const std::string& file, json& out) const {
  const CommandResult result = commands_.run({"info", file});
  static const std::regex kEvent(
      "(aborted|interrupted|notice|emergency_stop|session_stopped|overruns|problem) .*");
  std::istringstream lines(result.output);
  for (std::string line; std::getline(lines, line);) {
    if (std::regex_match(line, kEvent)) {
      out["last_event"] = {{"file", file}, {"text", line}};
    }
  }
}

json StudioViews::examples() const {
  const CommandWords words{"examples"};
  return {{"command", shown_command(words)}, {"rows", rows_of(run_good(words).output)}};
}

json StudioViews::machine() const {
  const CommandWords words{"doctor"};
  const CommandResult result = commands_.run(words);
  const auto last = result.output.find_last_not_of('\n');
  const auto begin = result.output.rfind('\n', last);
  return {{"command", shown_command(words)},
          {"fit", result.status == 0},
          {"rows", rows_of(result.output)},
          {"verdict", last == std::string::npos
                          ? ""
                          : result.output.substr(begin == std::string::npos ? 0 : begin + 1)}};
}

json StudioViews::begin(const std::string& name, const std::string& from) const {
  check_word("the name of the study", name);
  check_word("the name of the shipped definition", from);
  const CommandWords words{"new", name + ".toml", "--from", from};
  const CommandResult result = run_good(words);
  return {{"command", shown_command(words)}, {"file", name + ".toml"}, {"output", result.output}};
}

json StudioViews::text(const std::string& file) const {
  const StampedText read = folder_.read(folder_.definition(file), kMostDefinition);
  if (!is_utf8(read.text)) {
    throw InputError(fmt::format("{}: not a text in UTF-8; the studio does not open it", file));
  }
  return {{"text", read.text}, {"stamp", read.stamp}};
}

json StudioViews::validate(const std::string& file, const std::string& text) const {
  const Draft draft(folder_.definition(file), folder_.path(), text);
  const std::string sessions = StudyFolder::sessions_of(file);
  const bool has_sessions = !held_in(sessions).sessions.empty();
  const auto line_for = [&](const std::string& name) {
    CommandWords words{"validate", name};
    if (has_sessions) {
      words.insert(words.end(), {"--since", sessions});
    }
    return words;
  };
  const CommandResult result = commands_.run(line_for(draft.name()));
  const std::string output = draft.renamed(result.output);
  return {{"command", shown_command(line_for(file))},
          {"valid", result.status == 0},
          {"since", lines_that_begin(output, "since ")},
          {"remarks", remarks_json(read_remarks(output, file, result.status == 0))},
          {"output", output}};
}

json StudioViews::keys(const std::string& file, const std::string& text) const {
  const Draft draft(folder_.definition(file), folder_.path(), text);
  const CommandResult result = commands_.run({"set", draft.name(), "--list", "--json"});
  if (result.status != 0) {
    throw InputError(draft.renamed(result.output));
  }
  return {{"command", shown_command({"set", file, "--list"})},
          {"keys", json::parse(result.output, nullptr, false)}};
}

json StudioViews::set_key(const std::string& file, const std::string& text, const std::string& key,
                          const std::string& edit, const std::string& value) const {
  const Draft draft(folder_.definition(file), folder_.path(), text);
  const bool sets = edit != "add" && edit != "remove";
  CommandWords change = sets ? CommandWords{} : CommandWords{"--" + edit};
  if (key.starts_with('-') || value.starts_with('-')) {
    change.push_back("--");  // what follows is no option
  }
  change.push_back(key);
  if (sets) {
    change.push_back(value);
  }
  const auto line_for = [&change](const std::string& name, bool printed) {
    CommandWords words{"set", name};
    if (printed) {
      words.insert(words.end(), {"--output", "-"});
    }
    words.insert(words.end(), change.begin(), change.end());
    return words;
  };
  const CommandResult result = commands_.run(line_for(draft.name(), true));
  if (result.status != 0) {
    throw InputError(draft.renamed(result.output));
  }
  return {{"command", shown_command(line_for(file, false))}, {"text", result.output}};
}

json StudioViews::save(const std::string& file, const std::string& text,
                       const std::string& stamp) const {
  if (text.size() > kMostDefinition) {
    throw InputError(
        fmt::format("the definition has {} bytes; allowed: {}", text.size(), kMostDefinition));
  }
  return {{"stamp", folder_.save(file, text, stamp)}};
}

json StudioViews::schema(const std::string& protocol) const {
  check_word("the protocol", protocol);
  const CommandWords words{"keys", "--json-schema", protocol};
  return {{"command", shown_command(words)},
          {"schema", json::parse(run_good(words).output, nullptr, false)}};
}

json StudioViews::rehearse(const std::string& file, int subjects, std::optional<int> setup) const {
  folder_.definition(file);
  const std::string out = folder_.fresh_folder(file, "rehearsal");
  JobState about;
  about.study = file;
  about.folder = out;
  about.sessions = subjects;
  CommandWords words{"dry-run", file, "--subjects", std::to_string(subjects), "--out", out};
  if (setup) {
    words.insert(words.end(), {"--setup", std::to_string(*setup)});
  }
  return {{"command", shown_command(words)}, {"job", commands_.start(words, about)}};
}

json StudioViews::plan(const std::string& file) const {
  folder_.definition(file);
  JobState about;
  about.study = file;
  const CommandWords words{"plan", file};
  return {{"command", shown_command(words)}, {"job", commands_.start(words, about)}};
}

json StudioViews::power(const std::string& file) const {
  folder_.definition(file);
  JobState about;
  about.study = file;
  about.folder = folder_.fresh_folder(file, "power");
  const CommandWords words{"power", "simulate", file, "--out", about.folder};
  return {{"command", shown_command(words)}, {"job", commands_.start(words, about)}};
}

json StudioViews::analyze(const std::string& file, const std::string& folder) const {
  folder_.definition(file);
  if (!fs::is_directory(folder_.inside(folder))) {
    throw InputError(fmt::format("{}: not a folder of session files", folder));
  }
  JobState about;
  about.study = file;
  about.folder = folder;
  const CommandWords words{"analyze", folder};
  return {{"command", shown_command(words)}, {"job", commands_.start(words, about)}};
}

json StudioViews::jobs() const {
  json all = json::array();
  for (const JobState& job : commands_.jobs()) {
    const auto written = job.sessions > 0 ? held_in(job.folder).sessions.size() : std::size_t{0};
    all.push_back({{"job", job.number},
                   {"command", job.command},
                   {"study", job.study},
                   {"live", job.kind == JobState::Kind::kSession},
                   {"folder", job.folder},
                   {"sessions", job.sessions},
                   {"written", written},
                   {"state", name_of(job.state)},
                   {"status", job.status},
                   {"seconds", job.seconds},
                   {"bytes", job.bytes}});
  }
  return {{"jobs", all}};
}

json StudioViews::job(const std::string& number) const {
  return {{"output", commands_.output(number_of(number))}};
}

json StudioViews::sessions(const std::string& file) const {
  folder_.definition(file);
  json folders = json::array();
  for (const std::string& name : folder_.session_folders(file)) {
    const SessionFolder held = list_sessions(folder_.inside(name));
    folders.push_back({{"folder", name},
                       {"rehearsal", name != StudyFolder::sessions_of(file)},
                       {"sessions", files_json(held.sessions)},
                       {"results", files_json(held.results)},
                       {"report", held.report},
                       {"report_is_old", held.report_is_old}});
  }
  json exports = json::array();
  for (const std::string& name : folder_.export_folders(file)) {
    exports.push_back(
        {{"folder", name}, {"files", files_json(list_sessions(folder_.inside(name)).results)}});
  }
  return {{"folders", folders}, {"exports", exports}, {"own", StudyFolder::sessions_of(file)}};
}

json StudioViews::info(const std::string& file) const {
  if (folder_.inside(file).extension() != ".h5") {
    throw InputError(fmt::format("{}: not a session file; allowed: files that end in .h5", file));
  }
  const CommandWords words{"info", file};
  const CommandResult result = commands_.run(words);
  return {{"command", shown_command(words)},
          {"complete", result.status == 0},
          {"output", result.output}};
}

WebAnswer StudioViews::file(const std::string& name, bool download) const {
  const fs::path path = folder_.inside(name);
  const auto type = media_type(path.filename().string());
  if (!type) {
    throw InputError(fmt::format("{}: the studio shows reports, figures and tables alone", name));
  }
  WebAnswer answer = framed(*type, folder_.read(path, kMostFile).text);
  if (download) {
    static const std::regex kUnusual("[^A-Za-z0-9._-]");
    answer.headers["Content-Disposition"] = fmt::format(
        "attachment; filename=\"{}\"", std::regex_replace(path.filename().string(), kUnusual, "_"));
  }
  return answer;
}

WebAnswer StudioViews::library(const std::string& name) const {
  static const std::set<std::string, std::less<>> kFiles{
      "lib/codemirror.js",       "lib/codemirror.css",       "mode/toml/toml.js",
      "addon/hint/show-hint.js", "addon/hint/show-hint.css", "addon/search/searchcursor.js",
      "addon/search/search.js",  "addon/dialog/dialog.js",   "addon/dialog/dialog.css"};
  const fs::path file = libraries_ / "codemirror" / name;
  if (!kFiles.contains(name) || !fs::is_regular_file(file)) {
    return refusal(404, "CodeMirror is not installed here (Debian's package libjs-codemirror)");
  }
  const bool script = name.ends_with(".js");
  return {200, script ? "text/javascript; charset=utf-8" : "text/css; charset=utf-8",
          file_text(file)};
}

}  // namespace haptrial::experiments
