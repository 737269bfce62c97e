#include "core/base/definition/toml_cursor_internal.h"

#include <algorithm>
#include <regex>

namespace haptrial {

void TomlCursor::skip_blanks() {
  while (!ended() && is_blank(peek())) {
    ++at_;
  }
}

void TomlCursor::skip_comment() {
  if (peek() == '#') {
    while (!line_ended()) {
      ++at_;
    }
  }
}

void TomlCursor::skip_blank_lines() {
  do {
    skip_blanks();
    skip_comment();
    if (ended() || !line_ended()) {
      return;
    }
    while (peek() == '\r') {
      ++at_;
    }
    next();
  } while (true);
}

std::string_view TomlCursor::rest_of_line() const {
  std::size_t end = std::min(text_.find('\n', at_), text_.size());
  while (end > at_ && (is_blank(text_[end - 1]) || text_[end - 1] == '\r')) {
    --end;
  }
  return text_.substr(at_, end - at_);
}

std::string_view TomlCursor::rest_without_comment() const {
  const std::string_view rest = rest_of_line();
  return rest.substr(0, rest.find_last_not_of(" \t", rest.find(" #")) + 1);
}

bool TomlCursor::statement_begins() const {
  static const std::regex kStatement(
      "[ \t]*([A-Za-z0-9_.-]+[ \t]*=|\\[\\[?[ \t]*(?!true|false|inf|nan)[A-Za-z_]"
      "[A-Za-z0-9_.-]*[ \t]*\\])");
  const std::string_view rest = rest_of_line().substr(0, 200);
  return std::regex_search(rest.begin(), rest.end(), kStatement,
                           std::regex_constants::match_continuous);
}

}  // namespace haptrial
