#pragma once

#include <string>
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

/// Reads the table [groups] in its order; problems are noted. One group of everybody, without a
/// number of participants, where the definition has no such table.
std::vector<StudyGroup> read_groups(Table& root);

/// Notes that the groups have more or fewer participants in all than the design.
void check_group_sizes(Table& root, const std::vector<StudyGroup>& groups, int participants);

/// The group of a participant from the number at the end of the identifier: participants 1 to n
/// belong to the first group of n, those that follow to the next.
/// @throws InputError for a number beyond the last group, or none where there are several groups.
std::string group_of(const std::vector<StudyGroup>& groups, const std::string& subject);

/// @param participant  from 0
/// @returns null where the study states no groups, or none for the number
const StudyGroup* find_group(const std::vector<StudyGroup>& groups, int participant);

/// The name of that group; empty where there is none.
std::string group_of(const std::vector<StudyGroup>& groups, int participant);

}  // namespace haptrial::protocols
