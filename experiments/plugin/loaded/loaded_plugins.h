#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/base/error.h"

namespace haptrial::record {
class SessionReader;
}

namespace haptrial::experiments {

/// The kind of the events with which a session file keeps the plug-ins of each of its runs.
inline constexpr const char* kPluginEvent = "plug-in";

/// A plug-in that this program has loaded.
struct LoadedPlugin {
  std::string name;                // its own: letters, digits, '-', '_', '.'
  std::string version;             // its own, likewise
  std::string file;                // as it was named
  std::string checksum;            // of the file: SHA-256 in hexadecimal
  std::vector<std::string> gives;  // "protocol:springs", "field:wobble", ...
  std::string key_words;           // lines "PATH | DEFAULT | MEANING"
};

/// In the order in which they were loaded. Call before threads are started.
const std::vector<LoadedPlugin>& loaded_plugins();
void note_plugin(LoadedPlugin plugin);

/// What a session file keeps of each: "NAME VERSION CHECKSUM KIND:NAME ...".
std::vector<std::string> plugin_lines();

/// A session is resumed with the same plug-ins, to the bit. A run that was killed before it wrote
/// them is gone on with as it is. @throws InputError
void check_same_plugins(const record::SessionReader& before);

/// @throws InputError naming the plug-in that gave a protocol or a field that the definition of the
///         session names and this program does not have
/// @param sessions  a session file, or a folder of them; what cannot be read is passed over
void require_plugins(const std::filesystem::path& sessions);

/// What action() gives. If it refuses sessions that lack a plug-in, the sentence says which.
template <class Action>
auto with_plugins(const std::filesystem::path& sessions, Action action) {
  try {
    return action();
  } catch (const InputError&) {
    require_plugins(sessions);
    throw;
  }
}

}  // namespace haptrial::experiments
