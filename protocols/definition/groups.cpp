#include "protocols/definition/groups.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "core/base/definition/table.h"
#include "core/base/definition/toml_text_internal.h"
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

std::vector<StudyGroup> study_groups(std::string_view definition, std::string_view file_name) {
  const toml::table root = parse_toml(definition, file_name);
  std::vector<std::pair<toml::source_position, StudyGroup>> found;
  if (const toml::table* groups = root["groups"].as_table()) {
    for (const auto& [key, value] : *groups) {
      const auto count = value.value<std::int64_t>();
      constexpr std::int64_t kMost = 10000;
      if (!value.is_integer() || *count < 1 || *count > kMost) {
        throw InputError(
            fmt::format("{}: groups.{} is not a number of participants; allowed: 1 to {}",
                        file_name, key.str(), kMost));
      }
      found.push_back({key.source().begin,
                       {std::string(key.str()), static_cast<int>(*count), key.str() != kNovices}});
    }
  }
  std::sort(found.begin(), found.end(),
            [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<StudyGroup> result;
  for (auto& [position, group] : found) {
    result.push_back(std::move(group));
  }
  if (result.empty()) {
    result.push_back({kEverybody, 0, false});
  }
  return result;
}

std::vector<StudyGroup> read_groups(Table& root, int participants, std::string_view file_name) {
  if (!root.has("groups")) {
    return {};
  }
  Table table = root.table("groups");
  constexpr long kMost = 10000;
  long all = 0;
  bool good = true;
  for (const std::string& name : table.keys()) {
    table.describe(
        {name, "Participants of the group NAME, in the order of their numbers", "", true});
    const long count = table.integer(name, 1, kMost);
    good = good && count > 0;
    all += count;
  }
  if (good && all != participants) {
    root.reject("groups", fmt::format("has {} participants in all; make it {}, as in "
                                      "design.participants",
                                      all, participants));
  }
  return good ? study_groups(root.source(), file_name) : std::vector<StudyGroup>{};
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

std::string group_of(const std::vector<StudyGroup>& groups, int participant) {
  for (const StudyGroup& group : groups) {
    if (groups.size() > 1 && participant >= 0 && participant < group.participants) {
      return group.name;
    }
    participant -= group.participants;
  }
  return "";
}

}  // namespace haptrial::protocols
