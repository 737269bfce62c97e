#include "core/base/definition/toml_words_internal.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <regex>

#include "core/base/text/utf8.h"

namespace haptrial {
namespace {

/// Characters of word processors that look like those of TOML, and what to write for them.
struct LookAlike {
  std::string_view bytes;
  const char* mistake;
};
constexpr std::array<LookAlike, 12> kLookAlikes{
    {{"\u201c", "\u201c is a typographic quote; write the straight quote \""},
     {"\u201d", "\u201d is a typographic quote; write the straight quote \""},
     {"\u201e", "\u201e is a typographic quote; write the straight quote \""},
     {"\u2018", "\u2018 is a typographic quote; write the straight quote \""},
     {"\u2019", "\u2019 is a typographic quote; write the straight quote \""},
     {"\u00ab", "\u00ab is a typographic quote; write the straight quote \""},
     {"\u00bb", "\u00bb is a typographic quote; write the straight quote \""},
     {"\u00a0", "a no-break space stands here; write an ordinary space"},
     {"\u200b", "an invisible character (U+200B) stands here; delete it"},
     {"\ufeff", "an invisible character (U+FEFF) stands here; delete it"},
     {"\u2212", "\u2212 is a typographic minus; write the hyphen -"},
     {"\u2013", "\u2013 is a dash; write the hyphen -"}}};

std::string small_letters(std::string_view text) {
  std::string out(text);
  std::transform(out.begin(), out.end(), out.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
  return out;
}

/// The bytes of the character at the front of `text`, or 0 if it is not UTF-8.
std::size_t whole_character(std::string_view text) {
  const std::size_t count = character_bytes(text.front());
  if (count == 0 || text.size() < count) {
    return 0;
  }
  const bool whole = std::all_of(
      text.begin() + 1, text.begin() + static_cast<std::ptrdiff_t>(count), continues_character);
  return whole ? count : 0;
}

/// What is wrong with a word that begins like a number and is none.
std::string number_advice(const std::string& word) {
  static const std::regex kNoZero("([+-]?)(\\.[0-9]+)");
  static const std::regex kNoDecimals("([+-]?[0-9]+)\\.");
  static const std::regex kZeros("([+-]?)0+([0-9][0-9.]*)");
  static const std::regex kPunctuated("([+-]?[0-9][0-9._]*)[;:!?]+");
  static const std::regex kUnit("([+-]?[0-9.]+)[A-Za-z%].*");
  std::smatch match;
  if (std::regex_match(word, match, kNoZero)) {
    return fmt::format("{} is not a number; write {}0{}", word, match.str(1), match.str(2));
  }
  if (std::regex_match(word, match, kNoDecimals)) {
    return fmt::format("{} is not a number; write {}.0", word, match.str(1));
  }
  if (std::regex_match(word, match, kZeros)) {
    return fmt::format("{} begins with a zero; write {}{}", word, match.str(1), match.str(2));
  }
  if (std::regex_match(word, match, kPunctuated) && is_number_or_time(match.str(1))) {
    return fmt::format("{} is not a number; write {}", word, match.str(1));
  }
  if (std::regex_match(word, match, kUnit)) {
    return fmt::format("{} is not a number; write the number alone, without a unit",
                       short_text(word));
  }
  return fmt::format("{} is not a number", short_text(word));
}

}  // namespace

std::string short_text(std::string_view text) {
  constexpr std::size_t kLongest = 40;
  if (text.size() <= kLongest) {
    return std::string(text);
  }
  return std::string(cut_text(text, kLongest - 3)) + "...";
}

std::optional<std::string> look_alike_mistake(std::string_view text) {
  for (const LookAlike& odd : kLookAlikes) {
    if (text.substr(0, odd.bytes.size()) == odd.bytes) {
      return odd.mistake;
    }
  }
  return std::nullopt;
}

bool is_number_or_time(const std::string& word) {
  static const std::regex kInteger(
      "[+-]?(0|[1-9](_?[0-9])*)|0x[0-9A-Fa-f](_?[0-9A-Fa-f])*|"
      "0o[0-7](_?[0-7])*|0b[01](_?[01])*");
  static const std::regex kFloat(
      "[+-]?((0|[1-9](_?[0-9])*)(\\.[0-9](_?[0-9])*)?"
      "([eE][+-]?[0-9](_?[0-9])*)?|inf|nan)");
  static const std::regex kTime("[0-9]{4}-[0-9]{2}-[0-9]{2}.*|[0-9]{2}:[0-9]{2}.*");
  return std::regex_match(word, kInteger) || std::regex_match(word, kFloat) ||
         std::regex_match(word, kTime);
}

std::optional<std::string> word_mistake(const std::string& word) {
  const std::string small = small_letters(word);
  if (small == "true" || small == "yes" || small == "on") {
    return fmt::format("{} is not a value; write true", word);
  }
  if (small == "false" || small == "no" || small == "off") {
    return fmt::format("{} is not a value; write false", word);
  }
  const std::size_t sign = word.find_first_not_of("+-.");
  if (sign != std::string::npos && word[sign] >= '0' && word[sign] <= '9') {
    return number_advice(word);
  }
  return std::nullopt;
}

std::optional<TomlMistake> find_bad_bytes(std::string_view text) {
  if (text.substr(0, 2) == "\xff\xfe" || text.substr(0, 2) == "\xfe\xff") {
    return TomlMistake{1, "the text is UTF-16; save it as UTF-8"};
  }
  unsigned line = 1;
  for (std::size_t at = 0; at < text.size();) {
    const auto c = static_cast<unsigned char>(text[at]);
    const bool line_end = c == '\n' || (c == '\r' && text.substr(at, 2) == "\r\n");
    if ((c < ' ' && c != '\t' && !line_end) || c == 0x7f) {
      return TomlMistake{line, fmt::format("the line holds the control character U+{:04X}; "
                                           "delete it",
                                           c)};
    }
    const std::size_t bytes = whole_character(text.substr(at));
    if (bytes == 0) {
      return TomlMistake{line, "the line holds bytes that are not UTF-8; save the text as UTF-8"};
    }
    line += c == '\n' ? 1 : 0;
    at += bytes;
  }
  return std::nullopt;
}

}  // namespace haptrial
