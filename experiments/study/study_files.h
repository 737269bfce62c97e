#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "core/record/read/session_reader_forward.h"
#include "core/record/rows/session_types.h"

namespace haptrial::protocols {
struct Definition;
class Protocol;
}  // namespace haptrial::protocols

namespace haptrial::experiments {

/// Pilots are tried before a study and are no part of it: never analysed together with it.
enum class Pilots { kLeftOut, kAlone };

/// A file of a session, among which copies are looked for.
struct SessionCopy {
  record::SessionInfo::Identity identity;
  std::size_t passes{0};
  std::string name;
};

/// For each file the one that stays of those with its session: with the most passes, of equal ones
/// that with the shortest name.
std::vector<std::size_t> files_that_stay(const std::vector<SessionCopy>& files);

/// Files of different sessions.
struct DistinctSessions {
  std::vector<std::filesystem::path> files;
  std::vector<std::string> copies;  // "S01 copy.h5 (of S01.h5)", for a sentence
};

/// Leaves out files whose session is also in another one: a copy would count its trials twice.
DistinctSessions distinct_sessions(const std::vector<std::filesystem::path>& files);

/// The session files of a folder that `pilots` asks for, without copies, sorted by name.
/// @throws InputError when there are none.
std::vector<std::filesystem::path> files_of(const std::filesystem::path& folder, Pilots pilots);

/// files_of() of a study from which something is learned; pilots are left out.
/// @throws InputError also as definition_remarks() does, as when analysing the study.
std::vector<std::filesystem::path> files_of_one_study(const std::filesystem::path& folder,
                                                      const protocols::Protocol& protocol);

/// The names of the files of unfinished sessions in a folder, sorted; empty for no folder.
std::vector<std::string> unfinished_sessions(const std::filesystem::path& folder);

/// Whether a folder holds session files, finished or not.
bool holds_sessions(const std::filesystem::path& folder);

/// Whether the participant did not consent, so that nothing was presented.
bool is_declined(const record::SessionReader& reader);

/// Sessions that belong to one study.
struct StudyFiles {
  std::vector<std::filesystem::path> files;
  record::SessionInfo first;         // its definition, with the most participants, is the study's
  std::vector<std::string> remarks;  // sentences for the report
};

/// The protocol of a session, which the registry of studies knows.
using ProtocolOf = std::function<const protocols::Protocol&(const record::SessionInfo&)>;

/// @throws InputError as files_of() and definition_remarks() do.
StudyFiles study_files(const std::filesystem::path& folder, Pilots pilots,
                       const ProtocolOf& protocol_of);

/// Facts of the file whose definition plans most participants, the first of several: a study may
/// take further ones, whose groups the definitions before do not know.
/// @param files  at least one
record::SessionInfo largest_plan(const std::vector<std::filesystem::path>& files);

/// The participants who have had every session of their group, in the order in which they began
/// the last of them: those of whom a study that may end early has all data. Those of an import,
/// which begin together, come by their numbers, which are places in the tables.
std::vector<std::string> complete_participants(const std::vector<std::filesystem::path>& files,
                                               const protocols::Definition& definition);

}  // namespace haptrial::experiments
