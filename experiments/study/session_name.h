#pragma once

#include <functional>
#include <optional>
#include <string>

namespace haptrial::record {
struct SessionInfo;
}

namespace haptrial::experiments {

/// The name of a session's file: "P01.h5"; where participants come several times
/// "P01-session-2.h5", with as many digits as the last session has, so that names sort as sessions
/// follow each other.
/// @param session  from 1 to `sessions`
std::string session_file_name(const std::string& subject, int session, int sessions);

/// The number at the end of an identifier, from 1 to 10000; 0 if it has none.
int number_of_subject(const std::string& subject);

/// Folder beside the session files for those of excluded participants.
inline constexpr const char* kExcludedFolder = "excluded";

/// Identifier of whoever replaces an excluded participant: "Pb07" after "P07", then "Pc07".
std::string replacement_of(const std::string& subject,
                           const std::function<bool(const std::string&)>& is_taken);

/// Device of imported sessions.
inline constexpr const char* kNoDevice = "none";

/// The recorded number by which a session's orders were chosen; none in older files, and none of
/// imported sessions, whose number is the participant's place in the tables.
std::optional<int> recorded_number(const record::SessionInfo& info);

/// The number by which a session's orders were chosen: the recorded one, else that of the
/// identifier.
int number_of_session(const record::SessionInfo& info);

}  // namespace haptrial::experiments
