#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "experiments/study/study_files.h"

namespace haptrial::experiments {

/// The files in a study's folders that concern a participant who withdraws.
struct Withdrawal {
  std::vector<std::filesystem::path> sessions;  // session files, partial ones and copies, sorted
  std::vector<std::filesystem::path> made;      // tables, reports, pictures made from sessions
  std::vector<std::filesystem::path> others;    // other files that name the participant
  std::vector<std::filesystem::path> tables;    // that people filled in and may have a row of it
};

/// Looks through folders with all that is below them, of which the first is the study's own. A
/// session file is the participant's if it says so, and one that cannot be read if its name does.
/// Sessions of another study than those of the first folder, and folders that were exported from
/// another one, are left among `others`: there the identifier may be somebody else's. A table,
/// report or picture was made from sessions if it names the participant, or if it lies beside or
/// below such a file or the sessions, in no folder of another participant or study, and is younger
/// than the first of them: its numbers are partly the participant's. Sessions of others that name
/// the participant, such as those that the participant's recording led, are among `others`.
/// @throws InputError for a folder that is not there, a participant without a file, or one whose
/// session is being recorded
Withdrawal find_withdrawal(const std::vector<std::filesystem::path>& folders,
                           const std::string& subject, const ProtocolOf& protocol_of);

/// Deletes sessions and what was made from sessions, the participant's rows of excluded/reasons.csv
/// and of what raters said (ratings.csv, checklist.csv), and folders
/// that become empty by that; adds a row to withdrawals.csv in the first folder, with the time, the
/// user's login and how much was deleted, without the identifier.
/// @param folders  as they were looked through
/// @throws RunError for a file that cannot be deleted; those before it are gone then
void withdraw(const Withdrawal& found, const std::vector<std::filesystem::path>& folders,
              const std::string& subject);

/// Whether a text has a word: its neighbours are neither letters, digits nor '_'.
bool has_word(std::string_view text, std::string_view word);

}  // namespace haptrial::experiments
