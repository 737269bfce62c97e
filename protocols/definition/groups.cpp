#include "protocols/definition/groups.h"

#include <fmt/format.h>

#include <optional>

#include "core/base/definition/table.h"
#include "core/base/error.h"

namespace haptrial::protocols {
namespace {

constexpr const char* kNovices = "novices";
constexpr const char* kEverybody = "participants";

std::optional<int> number_at_end(const std::string& subject) {
  const auto letter = subject.find_last_not_of("0123456789");
  const std::string digits = subject.substr(letter == std::string::npos ? 0 : letter + 1);
  constexpr std::size_t kLongest = 5;
  return digits.empty() || digits.size() > kLongest ? std::nullopt
                                                    : std::optional<int>(std::stoi(digits));
}

}  // namespace

std::vector<StudyGroup> read_groups(Table& root) {
  if (!root.has("groups")) {
    return {{kEverybody, 0, false}};
  }
  Table table = root.table("groups");
  constexpr long kMost = 10000;
  std::vector<StudyGroup> groups;
  for (const std::string& name : table.keys_as_written()) {
    table.describe(
        {name, "Participants of the group NAME, in the order of their numbers", "", true});
    const long count = table.integer(name, 1, kMost);
    groups.push_back({name, static_cast<int>(count), name != kNovices});
  }
  if (groups.empty()) {
    root.reject("groups", "an empty table", "a group and its number of participants");
  }
  return groups;
}

void check_group_sizes(Table& root, const std::vector<StudyGroup>& groups, int participants) {
  int all = 0;
  for (const StudyGroup& group : groups) {
    if (group.participants == 0) {
      return;  // none is stated, or wrongly
    }
    all += group.participants;
  }
  if (all != participants) {
    root.reject("groups", fmt::format("has {} participants in all; make it {}, as in "
                                      "design.participants",
                                      all, participants));
  }
}

std::string group_of(const std::vector<StudyGroup>& groups, const std::string& subject) {
  if (groups.size() == 1) {
    return groups.front().name;
  }
  const std::optional<int> number = number_at_end(subject);
  int last = 0;
  for (const StudyGroup& group : groups) {
    last += group.participants;
    if (number && *number >= 1 && *number <= last) {
      return group.name;
    }
  }
  throw InputError(
      fmt::format("participant {} belongs to no group; allowed: an identifier that ends in a "
                  "number from 1 to {}",
                  subject, last));
}

const StudyGroup* find_group(const std::vector<StudyGroup>& groups, int participant) {
  for (const StudyGroup& group : groups) {
    if (participant >= 0 && participant < group.participants) {
      return &group;
    }
    participant -= group.participants;
  }
  return nullptr;
}

std::string group_of(const std::vector<StudyGroup>& groups, int participant) {
  const StudyGroup* group = find_group(groups, participant);
  return group != nullptr ? group->name : std::string();
}

}  // namespace haptrial::protocols
