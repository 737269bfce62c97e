#include "experiments/studio/views_internal.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <ranges>
#include <regex>
#include <sstream>
#include <system_error>

#include "core/base/error.h"

namespace haptrial::experiments {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

/// The object within what a command printed; warnings may stand around it.
json object_in(const std::string& output) {
  const auto begin = output.find('{');
  const auto end = output.rfind('}');
  if (begin == output.npos || end == output.npos || end < begin) {
    return {};
  }
  return json::parse(output.substr(begin, end - begin + 1), nullptr, false);
}

/// @param stem  "out/study-csv"  @returns the first name that is free: "out/study-csv-001"
std::string fresh_name(const fs::path& root, const std::string& stem, const std::string& ending) {
  for (int number = 1;; ++number) {
    std::string name = fmt::format("{}-{:03}{}", stem, number, ending);
    if (!fs::exists(fs::symlink_status(root / name))) {
      return name;
    }
  }
}

JobState job_of(const std::string& file, const std::string& folder) {
  JobState about;
  about.study = file;
  about.folder = folder;
  return about;
}

}  // namespace

json SessionViews::checklist(const SessionChoice& choice) const {
  folder_.definition(choice.file);
  CommandWords words = session_words("start", choice);
  words.emplace_back("--check");
  CommandWords asked = words;
  asked.emplace_back("--json");
  const CommandResult result = commands_.run(asked);
  json found = object_in(result.output);
  if (!found.is_object() || !found.contains("checks")) {
    return {{"command", shown_command(words)}, {"failure", result.output}};
  }
  found["command"] = shown_command(words);
  found["run"] = shown_command(session_words("run", choice));
  return found;
}

json SessionViews::begin(const SessionChoice& choice) const {
  folder_.definition(choice.file);
  JobState about = job_of(choice.file, StudyFolder::sessions_of(choice.file));
  about.kind = JobState::Kind::kSession;
  const CommandWords words = session_words("run", choice);
  return {{"command", shown_command(words)}, {"job", commands_.start(words, about)}};
}

json SessionViews::card(const SessionChoice& choice) const {
  folder_.definition(choice.file);
  const std::string sessions = StudyFolder::sessions_of(choice.file);
  std::error_code ignored;
  fs::create_directories(folder_.path() / "out", ignored);
  const std::string card = fresh_name(folder_.path(), sessions + "-card", ".html");
  CommandWords words = session_words("start", choice);
  words.insert(words.end(), {"--card", card});
  const CommandResult result = commands_.run(words);
  if (result.status != 0) {
    throw InputError(result.output);
  }
  return {{"command", shown_command(words)}, {"file", card}};
}

json SessionViews::session() const {
  for (const JobState& job : commands_.jobs() | std::views::reverse) {
    if (job.kind != JobState::Kind::kSession) {
      continue;
    }
    const std::string output = commands_.output(job.number);
    const bool runs = job.state == JobState::State::kRunning;
    const SessionAddresses at = runs ? addresses_in(output) : SessionAddresses();
    return {{"job", job.number},           {"command", job.command}, {"study", job.study},
            {"state", name_of(job.state)}, {"seconds", job.seconds}, {"output", output},
            {"console", at.console},       {"watch", at.watch}};
  }
  return {{"job", nullptr}};
}

json SessionViews::devices() const {
  static const std::regex kRow(R"((\S+)\s{2,}(ready|missing)\s{2,}(.+))");
  const CommandWords words{"devices"};
  const CommandResult result = commands_.run(words);
  json rows = json::array();
  std::istringstream lines(result.output);
  for (std::string line; std::getline(lines, line);) {
    if (std::smatch parts; std::regex_match(line, parts, kRow)) {
      rows.push_back({parts.str(1), parts.str(2), parts.str(3)});
    }
  }
  return {{"command", shown_command(words)}, {"rows", rows}};
}

static void check_device(const std::string& device) {
  static const std::regex kDevice("[a-z][a-z0-9-]{0,63}");
  if (!std::regex_match(device, kDevice)) {
    throw InputError("the device is not the name of one; allowed: those that the page lists");
  }
}

json SessionViews::read_device(const std::string& device, int seconds) const {
  check_device(device);
  const CommandWords words{"device-test", device, "--read", "--seconds", std::to_string(seconds)};
  return {{"command", shown_command(words)}, {"job", commands_.start(words, {})}};
}

json SessionViews::read_channels(const std::string& file, int seconds) const {
  folder_.definition(file);
  const CommandWords words{"record", file, "--seconds", std::to_string(seconds)};
  return {{"command", shown_command(words)}, {"job", commands_.start(words, {})}};
}

json SessionViews::test_device(const std::string& device, int seconds) const {
  check_device(device);
  const CommandWords words{"device-test", device, "--seconds", std::to_string(seconds)};
  return {{"command", shown_command(words)}, {"job", commands_.start(words, {})}};
}

json SessionViews::hand_over(const std::string& file, const std::string& folder,
                             const std::string& format) const {
  folder_.definition(file);
  const auto held = folder_.session_folders(file);
  if (std::ranges::find(held, folder) == held.end()) {
    throw InputError(fmt::format("{}: not a folder of sessions of {}", folder, file));
  }
  CommandWords words{"analyze", folder, "--paper", "85"};
  if (format == "csv" || format == "bids") {
    const std::string out = fresh_name(folder_.path(), folder + "-" + format, "");
    words = {"export", "--" + format, out, folder};
  } else if (format != "pdf") {
    throw InputError("the format is not known; allowed: csv, bids, pdf");
  }
  return {{"command", shown_command(words)}, {"job", commands_.start(words, job_of(file, folder))}};
}

json SessionViews::withdraw(const std::string& file, const std::string& subject, bool sure) const {
  folder_.definition(file);
  if (subject.starts_with('-')) {
    throw InputError("an identifier of a participant does not begin with -");
  }
  CommandWords words{"withdraw", StudyFolder::sessions_of(file), subject};
  for (const std::string& folder : folder_.export_folders(file)) {
    words.insert(words.end(), {"--also", folder});
  }
  const std::string asked = shown_command(words);
  words.push_back(sure ? "--yes" : "--dry-run");
  const CommandResult result = commands_.run(words);
  if (result.status != 0) {
    throw InputError(result.output);
  }
  return {{"command", asked}, {"output", result.output}};
}

}  // namespace haptrial::experiments
