#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace haptrial::protocols {
struct Definition;
}

namespace haptrial::protocols {
struct Definition;
}

namespace haptrial::experiments {

/// Durations of recorded sessions, breaks included [s].
struct SessionTimes {
  int sessions{0};
  double mean{0.0};
  double shortest{0.0};
  double longest{0.0};
};

/// Pages count only in sessions on the real clock; pilots, copies and sessions that were declined
/// or ended early do not count. @param files  of sessions of the definition
/// @returns nothing without a session
/// @throws InputError for a file that cannot be read
std::optional<SessionTimes> session_times(const std::vector<std::filesystem::path>& files,
                                          const protocols::Definition& definition);

/// Times of the sessions that a study's folder has; nothing where there is none, or no folder.
std::optional<SessionTimes> recorded_times(const std::filesystem::path& folder,
                                           const protocols::Definition& definition);

/// "21 minutes (18 to 26 in 12 sessions)".
std::string time_words(const SessionTimes& times);

/// "a session takes 21 minutes (18 to 26 in 12 sessions); 30 sessions take 10.5 hours, 18.0 in the
/// lab with 15 minutes between them". @param setup  between two sessions [min]
std::string lab_time(const SessionTimes& times, int sessions, std::optional<double> setup);

struct Roster;

/// Time of a session at most, roughly: its trials and the breaks between them, without pages [s].
/// @param trials  of the session, at least 1
double session_seconds(const protocols::Definition& definition, int trials);

/// Sessions that a study still needs until every planned participant has had all of them.
int sessions_to_come(const Roster& roster);

}  // namespace haptrial::experiments
