#include "protocols/psychophysics/definition/only_seen.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <iterator>
#include <set>
#include <utility>

#include "core/base/definition/table.h"
#include "core/base/nearest.h"
#include "protocols/definition/definition.h"
#include "protocols/definition/speech_options.h"
#include "protocols/psychophysics/definition/question.h"

namespace haptrial::protocols {
namespace {

std::vector<std::string> texts_or_none(Table& table, const char* key) {
  return table.has(key) ? table.texts(key) : std::vector<std::string>{};
}

/// Whether a field leads the hand somewhere.
bool leads(Table& root, const std::string& field) {
  static const std::set<std::string> kLeading{"spring", "minimum_jerk", "path", "curve"};
  if (!root.has("fields") || !root.table("fields").has(field)) {
    return false;
  }
  const auto type = root.table("fields").table(field).whole_text("type");
  return type && kLeading.contains(*type);
}

/// Names everything that a stage shows and nothing else carries.
std::vector<std::string> only_seen_in(Table& root, Table& stage) {
  const std::vector<std::string> fields = texts_or_none(stage, "fields");
  const bool led =
      std::ranges::any_of(fields, [&root](const std::string& field) { return leads(root, field); });
  std::vector<std::string> seen;
  if (led || stage.has("sound")) {
    return seen;
  }
  std::ranges::copy_if(texts_or_none(stage, "show"), std::back_inserter(seen),
                       [&](const std::string& name) {
                         return name != "hand" && name != "interval_number" && name != "null" &&
                                std::ranges::find(fields, name) == fields.end();
                       });
  return seen;
}

void add_choices(const TrialQuestion& question, std::vector<std::string>& sentences) {
  for (std::size_t i = 0; i < question.means.size(); ++i) {
    if (question.means[i].keys == 0 && !question.means[i].silent) {
      sentences.push_back(fmt::format(
          "the choice \"{}\" of \"{}\" has no key, and speech names keys alone; give it `keys`, or "
          "say in its label how it is given",
          question.choices[i].value, question.name));
    }
  }
}

}  // namespace

std::vector<std::string> only_seen(const Definition& definition,
                                   const std::vector<TrialQuestion>& questions) {
  std::vector<std::string> sentences;
  if (!speech_of(definition).spoken) {
    return sentences;
  }
  Table root = definition.root();
  for (Table& stage : root.tables("stages")) {
    const std::vector<std::string> seen = only_seen_in(root, stage);
    if (!seen.empty()) {
      sentences.push_back(fmt::format(
          "the stage \"{}\" shows {}, which speech does not tell and no force or sound carries; a "
          "blind participant cannot do it",
          stage.text("name"), fmt::join(seen, ", ")));
    }
  }
  for (const TrialQuestion& question : questions) {
    add_choices(question, sentences);
  }
  return sentences;
}

namespace {

/// Values that the program gives by itself.
constexpr std::array<std::string_view, 2> kOwn{"no", "main"};

bool is_letter(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '-' ||
         static_cast<unsigned char>(c) >= 0x80;
}

std::string without_comments(std::string_view text) {
  std::string kept;
  char quote = 0;
  bool comment = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    comment = comment ? c != '\n' : quote == 0 && c == '#';
    const bool escaped = quote == '"' && c == '\\';
    if (!comment && !escaped && (c == '"' || c == '\'')) {
      quote = quote == 0 ? c : quote == c ? '\0' : quote;
    }
    if (!comment) {
      kept += c;
    }
    if (escaped && i + 1 < text.size()) {
      kept += text[++i];
    }
  }
  return kept;
}

bool ends_with_comparison(std::string_view before) {
  const std::size_t last = before.find_last_not_of(" \t(");
  const std::string_view trimmed = before.substr(0, last + 1);
  return last != std::string_view::npos && (trimmed.ends_with("==") || trimmed.ends_with("!="));
}

bool begins_with_comparison(std::string_view after) {
  const std::size_t first = after.find_first_not_of(" \t)");
  const std::string_view trimmed = after.substr(std::min(first, after.size()));
  return trimmed.starts_with("==") || trimmed.starts_with("!=");
}

/// Takes the words that are compared with out of a text.
std::set<std::string> take_compared(std::string& text) {
  std::set<std::string> compared;
  std::size_t at = 0;
  while ((at = text.find('\'', at)) != std::string::npos) {
    const std::size_t end = text.find_first_of("'\"\n", at + 1);
    if (end == std::string::npos) {
      break;
    }
    const std::string_view whole(text);
    const bool word = text[end] == '\'' && (ends_with_comparison(whole.substr(0, at)) ||
                                            begins_with_comparison(whole.substr(end + 1)));
    if (word) {
      compared.insert(text.substr(at + 1, end - at - 1));
      text.replace(at, end + 1 - at, 1, ' ');
    } else {
      at = text[end] == '\'' ? end + 1 : end;
    }
  }
  return compared;
}

bool says(const std::string& text, const std::string& word) {
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) {
    const std::size_t end = at + word.size();
    if ((at == 0 || !is_letter(text[at - 1])) && (end == text.size() || !is_letter(text[end]))) {
      return true;
    }
  }
  return false;
}

std::vector<std::string> words_in(const std::string& text) {
  std::set<std::string> words(kOwn.begin(), kOwn.end());
  std::string word;
  for (const char c : text) {
    if (is_letter(c)) {
      word += c;
    } else if (!word.empty()) {
      words.insert(std::exchange(word, {}));
    }
  }
  return {words.begin(), words.end()};
}

}  // namespace

std::vector<std::string> unmatched_literals(std::string_view definition) {
  std::string text = without_comments(definition);
  std::vector<std::string> sentences;
  for (const std::string& word : take_compared(text)) {
    if (std::ranges::find(kOwn, word) == kOwn.end() && !says(text, word)) {
      sentences.push_back(
          fmt::format("a formula compares with '{}', which nothing in the definition ever is{}",
                      word, did_you_mean(word, words_in(text))));
    }
  }
  return sentences;
}

}  // namespace haptrial::protocols
