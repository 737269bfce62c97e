#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "experiments/study/next_case.h"
#include "protocols/interface/protocol.h"

namespace haptrial::experiments {

/// How a session stands, as its file says.
enum class SessionState : std::uint8_t {
  kDone,
  kAborted,     // ended for good by the experimenter, with trials left
  kDeclined,    // the participant did not consent
  kUnfinished,  // stopped or killed: --resume goes on with it
  kRunning      // another process is recording it
};
const char* name_of(SessionState state);

struct RosterSession {
  int session{1};
  SessionState state{SessionState::kDone};
  int trials{0};  // of the study that were done, without practice
  std::string file;
};

/// Somebody who has a session file.
struct RosterPerson {
  std::string subject;
  int number{0};      // that chose the orders; 0: an older file of an identifier without one
  std::string group;  // empty: the study has none, or the number belongs to none
  bool pilot{false};
  bool excluded{false};  // the files lie in the folder "excluded"
  bool simulated{false};
  std::vector<RosterSession> sessions;  // in their order
  int next{0};                          // session; 0: none is left
  NextCase next_case;                   // of it

  const RosterSession* session(int number) const;
  bool is_recorded_now() const;
  /// Did not consent, so nothing more is to be run.
  bool declined() const;
  /// Declined before any trial was done, so the number is free again.
  bool never_took_part() const;
};

/// A session that could be run now.
struct RosterNext {
  std::string subject;
  int number{0};
  std::string group;
  int session{1};
  bool fresh{true};  // somebody who has no session yet
  bool resume{false};
  std::vector<std::string>
      blocks{};                // in their order; none where the protocol has no words for them
  std::string session_name{};  // in the definition's words; empty: it has none
  NextCase next_case{};        // of a curriculum; without a name: the study has none
  std::string command{};
};

struct RosterGroup {
  std::string name;
  int planned{0};   // participants
  int begun{0};     // of them; no pilots, excluded ones or ones who never took part
  int finished{0};  // with every session
  int sessions{1};  // to which each of them comes
};

/// Participants of a study with their sessions, and the next session. It is read from the session
/// files every time and kept nowhere.
struct Roster {
  int sessions{1};  // of each participant
  std::uint64_t seed{1};
  std::vector<RosterGroup> groups;
  std::vector<RosterPerson> persons;  // by identifier; the study's, then excluded ones, then pilots
  /// The session to run if nobody in particular is there: the first of next. Then one new
  /// participant of every other group that has a place, then the sessions that known participants
  /// have left.
  std::vector<RosterNext> next;
  std::vector<std::string> remarks;  // sentences: files that cannot be read, numbers given twice
};

/// Request for a roster.
struct RosterRequest {
  const protocols::Protocol* protocol{nullptr};
  const protocols::Definition* definition{nullptr};
  std::string definition_file;          // as the command line of the next session has it
  std::filesystem::path folder;         // of session files; need not exist yet
  std::optional<std::uint64_t> seed{};  // default: that of the sessions, else 1
  FindCase find_case{};                 // of a study with a curriculum
  bool any_seed{false};  // sessions of other seeds are no error; somebody may be excluded for it
};

/// Numbers 1 to n are the participants that the definition plans, and a number says the group
/// (groups.h). A new participant gets the lowest free number of the group that has the smallest
/// share of its participants; the number of a participant who was excluded or declined before
/// any trial is free again, and its next holder has another identifier.
/// @throws InputError for a file of another study or seed, and a folder that is none; names it
Roster make_roster(const RosterRequest& request);

}  // namespace haptrial::experiments
