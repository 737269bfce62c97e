#pragma once

#include <string>
#include <vector>

#include "core/base/definition/schema_forward.h"

namespace haptrial::protocols {

/// A group of a study, in the order in which participants belong to them.
struct StudyGroup {
  std::string name;
  int participants{0};  // their numbers follow those of the group before
  bool expert{false};   // true of every group but one that is called novices
  int planned{0};       // participants, and the group's share of further ones of the design

  bool operator==(const StudyGroup&) const = default;
};

/// Reads the table [groups] in its order; problems are noted. One group of everybody, without a
/// number of participants, if the definition has no such table.
std::vector<StudyGroup> read_groups(Table& root);

/// Notes that the groups have more participants in all than the design. Participants whom the
/// design has beyond them belong to the groups in turn, as many of each as its share of the stated
/// sizes: with groups of 4 and 2 two of the first, one of the second, and so on. So a study takes
/// further participants, and nobody changes the group.
void plan_further(Table& root, std::vector<StudyGroup>& groups, int participants);

/// A sentence on participants beyond the groups' sizes; nothing if there is none.
std::vector<std::string> group_warnings(const std::vector<StudyGroup>& groups);

/// The group of a participant from the number at the end of the identifier: participants 1 to n
/// belong to the first group of n, those that follow to the next, and further ones as
/// plan_further() says.
/// @throws InputError for a number beyond those planned, or without a number if there are several
/// groups.
std::string group_of(const std::vector<StudyGroup>& groups, const std::string& subject);

/// @param participant  from 0
/// @returns null if the study states no groups, or none for the number
const StudyGroup* find_group(const std::vector<StudyGroup>& groups, int participant);

/// The name of that group; empty if there is none.
std::string group_of(const std::vector<StudyGroup>& groups, int participant);

}  // namespace haptrial::protocols
