#pragma once

#include <cstddef>
#include <string_view>

namespace haptrial {

inline bool is_blank(char c) { return c == ' ' || c == '\t'; }
inline bool is_quote(char c) { return c == '"' || c == '\''; }
inline bool is_digit(char c) { return c >= '0' && c <= '9'; }
inline bool is_bare(char c) {  // may stand in a key without quotes
  return is_digit(c) || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || c == '-';
}

/// A place in a TOML text and the line that it is in, counted from 1. Reading past the end gives
/// zero bytes.
class TomlCursor {
 public:
  explicit TomlCursor(std::string_view text) : text_(text) {}

  bool ended() const { return at_ >= text_.size(); }
  char peek(std::size_t ahead = 0) const {
    return at_ + ahead < text_.size() ? text_[at_ + ahead] : '\0';
  }
  bool starts(std::string_view with) const { return text_.substr(at_, with.size()) == with; }
  bool line_ended() const { return ended() || peek() == '\n' || starts("\r\n"); }
  void next() { line_ += text_[at_++] == '\n' ? 1 : 0; }
  void skip_blanks();
  void skip_comment();
  void skip_blank_lines();
  std::string_view rest_of_line() const;
  std::string_view rest_without_comment() const;
  /// Whether a key or a table's header stands here, which no array holds.
  bool statement_begins() const;

 protected:
  std::string_view text_;
  std::size_t at_{0};
  unsigned line_{1};
};

}  // namespace haptrial
