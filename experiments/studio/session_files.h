#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "experiments/studio/commands.h"

namespace haptrial::experiments {

/// A file of a folder of sessions.
struct FolderFile {
  std::string name;
  std::uintmax_t bytes{0};
  std::int64_t modified{0};  // since 1970 [ms]
};

/// The files of a folder of sessions; none, if it is not there.
struct SessionFolder {
  std::vector<FolderFile> sessions;    // finished ones, by name
  std::vector<FolderFile> unfinished;  // sessions, by name
  std::vector<FolderFile> results;     // reports, figures and tables, by name
  bool report{false};                  // report.html is there
  bool report_is_old{false};           // a session came, or an exclusion, since it was made

  /// The session that was written last, finished or not; null without sessions.
  const FolderFile* newest_session() const;
};

SessionFolder list_sessions(const std::filesystem::path& folder);

/// The media type of a file that the studio serves; nothing for others.
std::optional<std::string> media_type(const std::string& name);

/// How a session with a participant is to be run, as the page asks for it. Empty texts are left
/// out of the command.
struct SessionChoice {
  std::string file;     // the definition
  std::string subject;  // empty: whoever is next by the roster
  int session{0};       // of a study on several days; 0: the first that is left
  std::vector<std::string> devices;
  std::string language;
  std::string handedness;
  std::string consent;
  std::string watch;  // numeric address at which a phone may look on
  bool window{false};
  bool resume{false};
  bool pilot{false};
};

/// Words of `haptrial COMMAND` with these options; the console is always on, since the page has no
/// other way to stop a force.
/// @param command  "run" or "start"
/// @throws InputError for a value that could be taken for an option, or that no session has
CommandWords session_words(const std::string& command, const SessionChoice& choice);

/// Addresses that `haptrial run` printed; empty while there is none.
struct SessionAddresses {
  std::string console;
  std::string watch;
};

/// @param output  of a session so far. Only what looks like this program's own addresses is taken,
///                since texts of a definition may be among what is printed.
SessionAddresses addresses_in(const std::string& output);

}  // namespace haptrial::experiments
