#include "core/base/definition/given_in.h"

#include "core/base/definition/table.h"

namespace haptrial {

GivenIn read_given_in(Table& table, std::string_view key) {
  if (!table.has(key)) {
    return GivenIn::kAll;
  }
  const std::string word = table.choice(key, {"all", "none", "every other"});
  return word == "none"          ? GivenIn::kNone
         : word == "every other" ? GivenIn::kEveryOther
                                 : GivenIn::kAll;
}

bool is_given(GivenIn in, int trial, int participant) noexcept {
  return in == GivenIn::kAll || (in == GivenIn::kEveryOther && (trial + participant) % 2 == 1);
}

std::string given_word(std::string_view what, bool given) {
  return std::string(what) + (given ? " on" : " off");
}

std::vector<std::string> given_words(std::string_view what, GivenIn in) {
  std::vector<std::string> words;
  if (in != GivenIn::kNone) {
    words.push_back(given_word(what, true));
  }
  if (in != GivenIn::kAll) {
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
