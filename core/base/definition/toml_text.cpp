#include "core/base/definition/toml_text_internal.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include "core/base/error.h"
#include "core/base/utf8.h"

namespace haptrial {
namespace {

/// A key may hold keys in turn ("a.b.c = 1"). Thousands of them on one line are one inside the
/// other, and a tree that deep overflows the stack when it is destroyed.
constexpr int kMostDotsInKey = 100;

bool is_blank(char c) { return c == ' ' || c == '\t'; }
bool is_quote(char c) { return c == '"' || c == '\''; }
bool is_bare(char c) {  // may stand in a key without quotes
  return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' ||
         c == '-';
}

struct Mistake {
  std::size_t line;    // from 1
  std::size_t column;  // from 1, in characters
  std::string sentence;
};

/// Finds what must not reach the parser, which takes some things for granted: few keys within
/// each other, no letter beyond ASCII outside of quotes and comments, a name that follows the
/// bracket of a table's header, and brackets that are closed by their like.
class ParserGuard {
 public:
  explicit ParserGuard(std::string_view text) : text_(text) {
    at_ = starts("\ufeff") ? std::string_view("\ufeff").size() : 0;
    line_begin_ = at_;
  }

  std::optional<Mistake> find_hazard() {
    while (skip_quoted(), !ended()) {
      if (auto sentence = judge_character(); !sentence.empty()) {
        return Mistake{line_, column(), std::move(sentence)};
      }
      next();
    }
    return std::nullopt;
  }

 private:
  bool ended() const { return at_ >= text_.size(); }
  /// The byte at this place or further on; zero past the end.
  char peek(std::size_t ahead = 0) const {
    return at_ + ahead < text_.size() ? text_[at_ + ahead] : '\0';
  }
  bool starts(std::string_view with) const { return text_.substr(at_, with.size()) == with; }
  void next() {
    if (text_[at_++] == '\n') {
      ++line_;
      line_begin_ = at_;
    }
  }
  std::size_t column() const {
    const std::string_view before = text_.substr(line_begin_, at_ - line_begin_);
    return 1 + static_cast<std::size_t>(std::count_if(
                   before.begin(), before.end(), [](char c) { return !continues_character(c); }));
  }

  void skip_quoted() {
    while (peek() == '#' || is_quote(peek())) {
      if (peek() == '#') {
        at_ = std::min(text_.find('\n', at_), text_.size());
      } else {
        line_begins_ = false;
        skip_text();
      }
    }
  }

  /// A text in quotes; one that is not closed ends with its line.
  void skip_text() {
    const char quote = peek();
    const std::string around(starts(std::string(3, quote)) ? 3 : 1, quote);
    at_ += around.size();
    while (!ended() && !starts(around) && (around.size() > 1 || peek() != '\n')) {
      const bool escape = quote == '"' && peek() == '\\';
      next();
      if (escape && !ended()) {
        next();
      }
    }
    if (starts(around)) {
      at_ += around.size();
    }
    for (int more = 0; around.size() > 1 && more < 2 && peek() == quote; ++more) {
      ++at_;  // quotes at its end
    }
  }

  /// Says what is wrong with the character at this place, or nothing.
  std::string judge_character() {
    const char c = peek();
    if (static_cast<unsigned char>(c) >= 0x80) {
      const std::string_view character = text_.substr(at_, character_bytes(c));
      if (character.empty() || !is_utf8(character)) {
        return "the line holds bytes that are not UTF-8; save the text as UTF-8";
      }
      return fmt::format(
          "{} stands outside of quotes; write a text in quotes, and a key with letters from a to "
          "z, digits, _ and -",
          character);
    }
    if (c == '.' && ++dots_ > kMostDotsInKey) {
      return fmt::format("the line has more than {} dots without a comma; write shorter keys",
                         kMostDotsInKey);
    }
    if (c == '[' && line_begins_ && open_.empty() && !name_follows()) {
      return "no name follows the bracket of the table; write [NAME], with letters from a to z, "
             "digits, _ and -";
    }
    if (!follow_bracket(c)) {
      return fmt::format("{} stands where {} is open; write {} first", c, open_.back(),
                         open_.back() == '[' ? ']' : '}');
    }
    dots_ = c == '\n' || c == ',' ? 0 : dots_;  // a list of decimals has many dots
    line_begins_ = c == '\n' || (line_begins_ && is_blank(c));
    return "";
  }

  /// @returns whether a bracket or brace that closes fits the last one that is open
  bool follow_bracket(char c) {
    if (c == '[' || c == '{') {
      open_.push_back(c);
    } else if ((c == ']' || c == '}') && !open_.empty()) {
      if (open_.back() != (c == ']' ? '[' : '{')) {
        return false;
      }
      open_.pop_back();
    }
    return true;
  }

  bool name_follows() const {
    std::size_t ahead = peek(1) == '[' ? 2 : 1;
    while (is_blank(peek(ahead))) {
      ++ahead;
    }
    const bool letter = static_cast<unsigned char>(peek(ahead)) >= 0x80;  // judged by itself
    return letter || is_bare(peek(ahead)) || is_quote(peek(ahead));
  }

  std::string_view text_;
  std::size_t at_{0};
  std::size_t line_{1};
  std::size_t line_begin_{0};
  int dots_{0};
  std::string open_;  // brackets and braces
  bool line_begins_{true};
};

[[noreturn]] void refuse(const Mistake& mistake, std::string_view file_name) {
  throw InputError(fmt::format("{}:{}:{}: not valid TOML: {}", file_name, mistake.line,
                               mistake.column, mistake.sentence));
}

}  // namespace

toml::table parse_toml(std::string_view text, std::string_view file_name) {
  if (const auto hazard = ParserGuard(text).find_hazard()) {
    refuse(*hazard, file_name);
  }
  try {
    return toml::parse(text, file_name);
  } catch (const toml::parse_error& error) {
    const toml::source_position place = error.source().begin;
    std::string sentence(error.description());
    if (sentence.ends_with("could not determine value type")) {
      sentence += "; write a text in quotes";
    }
    refuse({place.line, place.column, std::move(sentence)}, file_name);
  }
}

}  // namespace haptrial
