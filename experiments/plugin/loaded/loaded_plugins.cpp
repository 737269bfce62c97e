#include "experiments/plugin/loaded/loaded_plugins.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>
#include <sstream>
#include <utility>

#include "core/record/read/session_reader.h"

namespace haptrial::experiments {
namespace fs = std::filesystem;
namespace {

std::vector<LoadedPlugin>& all_loaded() {
  static std::vector<LoadedPlugin> plugins;
  return plugins;
}

bool is_given(const std::string& what) {
  return std::any_of(all_loaded().begin(), all_loaded().end(), [&](const LoadedPlugin& plugin) {
    return std::find(plugin.gives.begin(), plugin.gives.end(), what) != plugin.gives.end();
  });
}

/// A plug-in that was loaded beside a session and had no part in its definition is not needed.
bool has_word(const std::string& definition, const std::string& word) {
  return definition.find('"' + word + '"') != std::string::npos ||
         definition.find('\'' + word + '\'') != std::string::npos;
}

/// The plug-ins of all runs of a session, each once.
std::vector<std::string> lines_of(const record::SessionReader& session) {
  std::vector<std::string> lines;
  for (const record::EventRow& event : session.events()) {
    if (event.kind == kPluginEvent &&
        std::find(lines.begin(), lines.end(), event.text) == lines.end()) {
      lines.push_back(event.text);
    }
  }
  return lines;
}

/// "springs 1.0, wobble 2.1" of their lines.
std::string names_of(const std::vector<std::string>& lines) {
  std::vector<std::string> names;
  for (const std::string& line : lines) {
    names.push_back(line.substr(0, line.find(' ', line.find(' ') + 1)));
  }
  return names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "));
}

void require_plugins_of(const record::SessionReader& session) {
  for (const std::string& line : lines_of(session)) {
    std::istringstream words(line);
    std::string name;
    std::string version;
    std::string what;
    words >> name >> version >> what;  // another build of it may do as well
    while (words >> what) {
      const std::size_t colon = what.find(':');
      const std::string kind = what.substr(0, colon);
      const std::string word = colon == std::string::npos ? "" : what.substr(colon + 1);
      if ((kind == "protocol" || kind == "field") && !is_given(what) &&
          has_word(session.info().definition, word)) {
        throw InputError(
            fmt::format("{}: was recorded with the plug-in {} {}, which has its {} '{}' and is not "
                        "loaded; add --plugin FILE",
                        session.path().string(), name, version, kind, word));
      }
    }
  }
}

}  // namespace

const std::vector<LoadedPlugin>& loaded_plugins() { return all_loaded(); }

void note_plugin(LoadedPlugin plugin) { all_loaded().push_back(std::move(plugin)); }

std::vector<std::string> plugin_lines() {
  std::vector<std::string> lines;
  for (const LoadedPlugin& plugin : all_loaded()) {
    lines.push_back(fmt::format("{} {} {} {}", plugin.name, plugin.version, plugin.checksum,
                                fmt::join(plugin.gives, " ")));
  }
  return lines;
}

void check_same_plugins(const record::SessionReader& before) {
  const std::vector<std::string> was = lines_of(before);
  const std::vector<std::string> is = plugin_lines();
  const bool nothing_yet = was.empty() && before.begun().empty() && before.passes().empty();
  const bool same =
      was.size() == is.size() && std::is_permutation(was.begin(), was.end(), is.begin());
  if (!same && !nothing_yet) {
    throw InputError(
        fmt::format("{}: was recorded with the plug-ins {}; resume it with the same "
                    "files, not with {}",
                    before.path().string(), names_of(was),
                    names_of(was) == names_of(is) ? "another build" : names_of(is)));
  }
}

void require_plugins(const fs::path& sessions) {
  std::vector<fs::path> files{sessions};
  if (fs::is_directory(sessions)) {
    files.assign(fs::directory_iterator(sessions), fs::directory_iterator());
    std::erase_if(files, [](const fs::path& file) { return file.extension() != ".h5"; });
    std::sort(files.begin(), files.end());
  }
  for (const fs::path& file : files) {
    std::optional<record::SessionReader> session;
    try {
      session.emplace(file);
    } catch (const InputError&) {
      continue;  // what is wrong with it was told already
    }
    require_plugins_of(*session);
  }
}

}  // namespace haptrial::experiments
