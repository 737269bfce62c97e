#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace haptrial {
class Table;
}

namespace haptrial::protocols {

/// A group of a study, in the order in which participants belong to them.
struct StudyGroup {
  std::string name;
  int participants{0};
  bool expert{false};  // every group but one that is called novices

  bool operator==(const StudyGroup&) const = default;
};

/// The [groups] of a definition's text, in its order; one group of everybody where it has none.
/// @throws InputError for a number of participants that is none.
std::vector<StudyGroup> study_groups(std::string_view definition, std::string_view file_name);

/// Reads the table [groups]; problems are noted. None where the definition has no such table.
/// @param participants  that the design has  @param file_name  without folders
std::vector<StudyGroup> read_groups(Table& root, int participants, std::string_view file_name);

/// The group of a participant from the number at the end of the identifier: participants 1 to n
/// belong to the first group of n, those that follow to the next.
/// @throws InputError for a number beyond the last group, or none where there are several groups.
std::string group_of(const std::vector<StudyGroup>& groups, const std::string& subject);

/// The group of a participant; empty where the study has none for that number.
/// @param participant  from 0
std::string group_of(const std::vector<StudyGroup>& groups, int participant);

}  // namespace haptrial::protocols
