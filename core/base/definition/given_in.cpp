#include "core/base/definition/given_in.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "core/base/definition/table.h"

namespace haptrial {

GivenIn read_given_in(Table& table, std::string_view key) {
  GivenIn in;
  if (!table.has(key)) {
    return in;
  }
  if (table.is_array(key)) {
    in.groups = table.texts(key);
    return in;
  }
  const std::string word = table.choice(key, {"all", "none", "every other"});
  in.trials = word == "none"          ? GivenIn::kNone
              : word == "every other" ? GivenIn::kEveryOther
                                      : GivenIn::kAll;
  return in;
}

bool is_given(const GivenIn& in, const GivenPlace& place) noexcept {
  if (!in.groups.empty()) {
    return std::ranges::find(in.groups, place.group) != in.groups.end();
  }
  return in.trials == GivenIn::kAll ||
         (in.trials == GivenIn::kEveryOther && (place.trial + place.participant) % 2 == 1);
}

std::string given_text(const GivenIn& in, std::string_view trial) {
  if (!in.groups.empty()) {
    return fmt::format("in every {} of the {} {}", trial,
                       in.groups.size() == 1 ? "group" : "groups", fmt::join(in.groups, ", "));
  }
  return in.trials == GivenIn::kAll          ? fmt::format("in every {}", trial)
         : in.trials == GivenIn::kEveryOther ? "in every other one"
                                             : "";
}

std::string given_word(std::string_view what, bool given) {
  return std::string(what) + (given ? " on" : " off");
}

std::vector<std::string> given_words(std::string_view what, const GivenIn& in, bool paused) {
  std::vector<std::string> words;
  if (in.trials != GivenIn::kNone) {
    words.push_back(given_word(what, true));
  }
  if (in.trials != GivenIn::kAll || !in.groups.empty() || paused) {
    words.push_back(given_word(what, false));
  }
  return words;
}

std::vector<std::string> joined_words(const std::vector<std::string>& first,
                                      const std::vector<std::string>& second) {
  if (first.empty() || second.empty()) {
    return first.empty() ? second : first;
  }
  std::vector<std::string> words;
  for (const std::string& a : first) {
    for (const std::string& b : second) {
      words.push_back(a + ", " + b);
    }
  }
  return words;
}

bool says_off(std::string_view condition, std::string_view what) noexcept {
  while (!condition.empty()) {
    const std::size_t comma = condition.find(", ");
    const std::string_view part = condition.substr(0, comma);
    if (part.size() == what.size() + 4 && part.starts_with(what) && part.ends_with(" off")) {
      return true;
    }
    condition = comma == std::string_view::npos ? "" : condition.substr(comma + 2);
  }
  return false;
}

}  // namespace haptrial
