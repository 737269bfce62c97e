#include "protocols/definition/groups.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <numeric>
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

/// The place of a participant's group. @param participant  from 0; the groups have sizes
std::size_t group_at(const std::vector<StudyGroup>& groups, int participant) {
  int stated = 0, unit = 0;
  for (const StudyGroup& group : groups) {
    stated += group.participants;
    unit = std::gcd(unit, group.participants);
  }
  const bool further = participant >= stated;
  int left = further ? (participant - stated) % (stated / unit) : participant;
  std::size_t at = 0;
  const auto size = [&] {
    return further ? groups[at].participants / unit : groups[at].participants;
  };
  for (; left >= size(); ++at) {
    left -= size();
  }
  return at;
}

int planned_in_all(const std::vector<StudyGroup>& groups) {
  int all = 0;
  for (const StudyGroup& group : groups) {
    all += group.planned;
  }
  return all;
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
    const int size = static_cast<int>(count);
    groups.push_back({name, size, name != kNovices, size});
  }
  if (groups.empty()) {
    root.reject("groups", "an empty table", "a group and its number of participants");
  }
  return groups;
}

void plan_further(Table& root, std::vector<StudyGroup>& groups, int participants) {
  if (groups.empty() || std::ranges::any_of(groups, [](const StudyGroup& group) {
        return group.participants == 0;
      })) {
    return;  // none is stated, or wrongly
  }
  const int all = planned_in_all(groups);
  for (int further = all; further < participants; ++further) {
    ++groups[group_at(groups, further)].planned;
  }
  if (all > participants) {
    root.reject("groups", fmt::format("has {} participants in all; make it {}, as in "
                                      "design.participants",
                                      all, participants));
  }
}

std::vector<std::string> group_warnings(const std::vector<StudyGroup>& groups) {
  std::vector<std::string> further;
  int first = 1;
  for (const StudyGroup& group : groups) {
    first += group.participants;
    if (group.planned > group.participants) {
      further.push_back(fmt::format("{} of {}", group.planned - group.participants, group.name));
    }
  }
  if (further.empty()) {
    return {};
  }
  return {fmt::format(
      "design.participants is {}, and the groups have {}: participants from number {} on belong to "
      "the groups in turn ({})",
      planned_in_all(groups), first - 1, first, fmt::join(further, ", "))};
}

std::string group_of(const std::vector<StudyGroup>& groups, const std::string& subject) {
  if (groups.size() == 1) {
    return groups.front().name;
  }
  const std::optional<int> number = number_at_end(subject);
  if (const StudyGroup* group = number ? find_group(groups, *number - 1) : nullptr) {
    return group->name;
  }
  throw InputError(
      fmt::format("participant {} belongs to no group; allowed: an identifier that ends in a "
                  "number from 1 to {}",
                  subject, planned_in_all(groups)));
}

const StudyGroup* find_group(const std::vector<StudyGroup>& groups, int participant) {
  return participant >= 0 && participant < planned_in_all(groups)
             ? &groups[group_at(groups, participant)]
             : nullptr;
}

std::string group_of(const std::vector<StudyGroup>& groups, int participant) {
  const StudyGroup* group = find_group(groups, participant);
  return group != nullptr ? group->name : std::string();
}

}  // namespace haptrial::protocols
