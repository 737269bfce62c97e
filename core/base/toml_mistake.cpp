#include "core/base/toml_mistake_internal.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <regex>
#include <tuple>

#include "core/base/toml_words_internal.h"

namespace haptrial {
namespace {

constexpr int kDeepest =
    100;  // arrays and tables in each other; deeper ones are left to the parser

bool is_blank(char c) { return c == ' ' || c == '\t'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_bare(char c) {  // may stand in a key without quotes
  return is_digit(c) || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || c == '-';
}

/// Walks through a document statement by statement and stops at the first mistake. Every step
/// returns whether to go on.
class Walk {
 public:
  explicit Walk(std::string_view text) : text_(text) {
    if (text_.substr(0, 3) == "\ufeff") {
      at_ = 3;
    }
  }

  std::optional<TomlMistake> mistake() {
    while (!gave_up_ && !found_) {
      skip_blank_lines();
      if (ended()) {
        break;
      }
      if (!(peek() == '[' ? header() : pair(table_, false)) || !end_of_statement()) {
        break;
      }
    }
    return gave_up_ ? std::nullopt : found_;
  }

 private:
  using Path = std::string;  // "trajectory.speed"

  bool ended() const { return at_ >= text_.size(); }
  char peek(std::size_t ahead = 0) const {
    return at_ + ahead < text_.size() ? text_[at_ + ahead] : '\0';
  }
  bool starts(std::string_view with) const { return text_.substr(at_, with.size()) == with; }
  bool line_ended() const { return ended() || peek() == '\n' || starts("\r\n"); }
  void next() { line_ += text_[at_++] == '\n' ? 1 : 0; }
  void skip_blanks() {
    while (!ended() && is_blank(peek())) ++at_;
  }
  void skip_comment() {
    if (peek() == '#') {
      while (!line_ended()) ++at_;
    }
  }
  void skip_blank_lines() {
    do {
      skip_blanks();
      skip_comment();
      if (ended() || !line_ended()) {
        return;
      }
      while (peek() == '\r') ++at_;
      next();
    } while (true);
  }
  std::string_view rest_of_line() const {
    std::size_t end = std::min(text_.find('\n', at_), text_.size());
    while (end > at_ && (is_blank(text_[end - 1]) || text_[end - 1] == '\r')) --end;
    return text_.substr(at_, end - at_);
  }

  std::string_view rest_without_comment() const {
    const std::string_view rest = rest_of_line();
    return rest.substr(0, rest.find_last_not_of(" \t", rest.find(" #")) + 1);
  }

  bool fail(unsigned line, std::string sentence) {
    found_ = TomlMistake{line, std::move(sentence)};
    return false;
  }
  bool give_up() {
    gave_up_ = true;
    return false;
  }
  /// A character of a word processor at this place.
  bool fail_look_alike() {
    const auto mistake = look_alike_mistake(text_.substr(at_));
    return mistake && !fail(line_, *mistake);
  }

  bool remember(const Path& path, unsigned line, const std::string& shown) {
    const auto [first, fresh] = given_.emplace(path, line);
    return fresh || fail(line, fmt::format("{} is given twice; line {} has it already", shown,
                                           first->second));
  }

  /// A letter of another language, or a sign, in the key that begins at `begin`.
  bool fail_odd_key(std::size_t begin) {
    const bool odd = static_cast<unsigned char>(peek()) >= 0x80 ||
                     (peek() != '\0' &&
                      std::string_view("!$%&()*+/?@^|~").find(peek()) != std::string_view::npos);
    if (!odd || (at_ > begin && !is_bare(text_[at_ - 1]))) {
      return false;
    }
    const std::string_view name =
        text_.substr(begin, text_.find_first_of(" \t\r\n=]#", begin) - begin);
    fail(line_, fmt::format("the key {} has a character that is not allowed; use letters from a to "
                            "z, digits, _ and -",
                            short_text(name)));
    return true;
  }

  bool header() {
    const unsigned line = line_;
    const bool list = starts("[[");
    const std::string open = list ? "[[" : "[", close = list ? "]]" : "]";
    at_ += open.size();
    skip_blanks();
    if (line_ended() || peek() == ']') {
      return fail(line, fmt::format("{}{} has no name; write {}NAME{}", open, close, open, close));
    }
    Path path;
    const std::size_t begin = at_;
    if (!key(path)) {
      return false;
    }
    if (fail_look_alike() || fail_odd_key(begin)) {
      return false;
    }
    skip_blanks();
    if (!starts(close)) {
      return fail_look_alike() ? false
                               : fail(line, fmt::format("the table header {}{} has no closing {}; "
                                                        "write {}{}{}",
                                                        open, short_text(path), close, open,
                                                        short_text(path), close));
    }
    at_ += close.size();
    if (list || tables_of_lists_ > 0) {  // a table within [[NAME]] belongs to the last of these
      table_ = fmt::format("{}#{}", path, ++tables_of_lists_);
      return true;
    }
    table_ = path;
    return remember(path, line, fmt::format("[{}]", short_text(path)));
  }

  /// A key with its dots; appended to `path`.
  bool key(Path& path) {
    while (true) {
      skip_blanks();
      if (peek() == '"' || peek() == '\'') {
        const std::size_t begin = at_;
        if (!short_string()) {
          return false;
        }
        path += text_.substr(begin, at_ - begin);
      } else {
        const std::size_t begin = at_;
        while (is_bare(peek())) ++at_;
        if (at_ == begin) {
          return fail_key(begin);
        }
        path += text_.substr(begin, at_ - begin);
      }
      const std::size_t after = at_;
      skip_blanks();
      if (peek() != '.') {
        at_ = after;
        return true;
      }
      ++at_;
      path += '.';
    }
  }

  bool fail_key(std::size_t begin) {
    if (fail_look_alike() || fail_odd_key(begin)) {
      return false;
    }
    return peek() == '=' ? fail(line_, "no key stands before =; write KEY = VALUE") : give_up();
  }

  /// KEY = VALUE. @param within  an inline table
  bool pair(const Path& table, bool within, int depth = 0) {
    const unsigned line = line_;
    Path name;
    const std::size_t begin = at_;
    if (!key(name)) {
      return false;
    }
    if (fail_look_alike() || fail_odd_key(begin)) {
      return false;
    }
    skip_blanks();
    if (peek() != '=') {
      return fail_equals(line, name);
    }
    ++at_;
    skip_blanks();
    if (line_ended() || peek() == '#' || (within && (peek() == ',' || peek() == '}'))) {
      return fail(line, fmt::format("{} has no value; write {} = VALUE", short_text(name),
                                    short_text(name)));
    }
    const Path path = table.empty() ? name : table + "." + name;
    return value(path, within ? '}' : '\n', depth) && (within || remember(path, line, name));
  }

  bool fail_equals(unsigned line, const std::string& name) {
    const std::string key = short_text(name);
    if (fail_look_alike()) {
      return false;
    }
    if (is_bare(peek()) || peek() == '"') {
      const std::string_view rest = rest_of_line();
      const std::string_view word = rest.substr(0, rest.find_first_of(" \t="));
      if (rest.find('=') != std::string_view::npos) {
        return fail(line, fmt::format("\"{} {}\" is not a key; a key has no spaces, such as {}_{}",
                                      key, short_text(word), key, short_text(word)));
      }
    }
    return fail(line, fmt::format("no = follows {}; write {} = VALUE", key, key));
  }

  /// @param end  what closes the table around it: ']', '}', or '\n' for none
  bool value(const Path& path, char end, int depth) {
    if (depth > kDeepest) {
      return give_up();
    }
    if (starts("\"\"\"") || starts("'''")) {
      return long_string();
    }
    switch (peek()) {
      case '"':
      case '\'':
        return short_string();
      case '[':
        return array(path, depth + 1);
      case '{':
        return inline_table(path, depth + 1);
      default:
        return word(end);
    }
  }

  bool long_string() {
    const unsigned line = line_;
    const std::string quotes(text_.substr(at_, 3));
    for (at_ += 3; !ended(); next()) {
      if (peek() == '\\' && quotes[0] == '"') {
        next();
        if (ended()) {
          break;
        }
      } else if (starts(quotes)) {
        at_ += 3;
        for (int more = 0; more < 2 && peek() == quotes[0]; ++more) ++at_;  // quotes at its end
        return true;
      }
    }
    return fail(line, fmt::format("the text that begins with {} here is never closed; write {} at "
                                  "its end",
                                  quotes, quotes));
  }

  bool short_string() {
    const std::size_t begin = at_;
    const char quote = peek();
    for (++at_; !line_ended(); ++at_) {
      if (peek() == quote) {
        ++at_;
        return true;
      }
      if (quote == '"' && peek() == '\\') {
        ++at_;
        if (std::string_view("btnfr\"\\uU").find(peek()) == std::string_view::npos) {
          return fail(line_,
                      "a backslash in a text in quotes begins an escape; write \\\\, or ' in "
                      "place of the quotes \"");
        }
      }
    }
    if (goes_on(quote)) {
      return fail(line_,
                  fmt::format("a text of several lines needs {0}{0}{0} at both ends", quote));
    }
    std::string_view line = text_.substr(begin, at_ - begin);
    return fail(line_, fmt::format("the text {} has no closing quote; write {} at its end",
                                   short_text(line), quote));
  }

  /// Whether the text that this line leaves open is closed in a later one.
  bool goes_on(char quote) {
    const auto [at, line] = std::pair(at_, line_);
    bool closed = false;
    while (!closed && !ended()) {
      while (!line_ended()) ++at_;
      while (peek() == '\r') ++at_;
      if (!ended()) next();
      const std::string_view rest = rest_of_line();
      if (ended() || statement_begins()) break;
      const auto quotes = std::count(rest.begin(), rest.end(), quote);
      closed = quotes % 2 == 1;
      if (quotes > 0 && !closed) break;
    }
    std::tie(at_, line_) = std::pair(at, line);
    return closed;
  }

  /// Whether a key or a table's header stands here, which no array holds.
  bool statement_begins() const {
    static const std::regex kStatement(
        "[ \t]*([A-Za-z0-9_.-]+[ \t]*=|\\[\\[?[ \t]*(?!true|false|inf|nan)[A-Za-z_]"
        "[A-Za-z0-9_.-]*[ \t]*\\])");
    const std::string_view rest = rest_of_line().substr(0, 200);
    return std::regex_search(rest.begin(), rest.end(), kStatement,
                             std::regex_constants::match_continuous);
  }

  bool array(const Path& path, int depth) {
    const unsigned line = line_;
    const auto unclosed = [&] {
      return fail(line, "the array that begins here has no closing bracket; write ] at its end");
    };
    ++at_;
    while (true) {
      skip_blank_lines();
      if (ended() || (line_ > line && statement_begins())) {
        return unclosed();
      }
      if (peek() == ']') {
        ++at_;
        return true;
      }
      if (peek() == ',') {
        return fail(line_, "a comma in an array follows no value; delete it");
      }
      if (!value(path, ']', depth)) {
        return false;
      }
      const unsigned value_line = line_;
      skip_blank_lines();
      if (peek() == ',') {
        ++at_;
      } else if (ended() || (line_ > line && statement_begins())) {
        return unclosed();
      } else if (peek() != ']') {
        return fail_look_alike()
                   ? false
                   : fail(value_line, fmt::format("a comma or a bracket is missing before \"{}\"",
                                                  short_text(rest_without_comment())));
      }
    }
  }

  bool inline_table(const Path& path, int depth) {
    const unsigned line = line_;
    const auto unclosed = [&] {
      return fail(line,
                  "the table that begins with { here has no closing brace; write } at its "
                  "end, in the same line");
    };
    ++at_;
    skip_blanks();
    if (peek() == '}') {
      ++at_;
      return true;
    }
    while (true) {
      skip_blanks();
      if (line_ended() || peek() == '#') {
        return unclosed();
      }
      if (peek() == '}') {
        return fail(line_, "a comma stands before }; delete it");
      }
      if (!pair(path, true, depth)) {
        return false;
      }
      skip_blanks();
      if (peek() == '}') {
        ++at_;
        return true;
      }
      if (line_ended() || peek() == '#') {
        return unclosed();
      }
      if (peek() != ',') {
        return fail_look_alike() ? false
                                 : fail(line_, fmt::format("a comma or }} is missing before \"{}\"",
                                                           short_text(rest_without_comment())));
      }
      ++at_;
    }
  }

  /// A number, time, true or false.
  bool word(char end) {
    if (fail_look_alike()) {
      return false;
    }
    const std::size_t begin = at_;
    while (!line_ended() && !is_blank(peek()) &&
           std::string_view(",]}#").find(peek()) == std::string_view::npos) {
      ++at_;
    }
    const std::string token(text_.substr(begin, at_ - begin));
    if (is_number_or_time(token)) {
      return decimal_point(token, end) && time_after_date(token);
    }
    if (token == "true" || token == "false") {
      return true;
    }
    if (const auto mistake = word_mistake(token)) {
      return fail(line_, *mistake);
    }
    return fail_unquoted(begin, end, token);
  }

  bool fail_unquoted(std::size_t begin, char end, std::string text) {
    if (end == '\n') {  // names may have spaces
      at_ = begin;
      text = std::string(rest_without_comment());
    }
    if (!text.empty() && (text.back() == '"' || text.back() == '\'')) {
      return fail(line_, fmt::format("the text {} has no opening quote; write {} before it",
                                     short_text(text), text.back()));
    }
    if (text.empty() || !is_bare(text[0])) {
      return give_up();
    }
    return fail(line_, fmt::format("{} is a text without quotes; write \"{}\"", short_text(text),
                                   short_text(text)));
  }

  /// "0,5": in an array that is two values.
  bool decimal_point(const std::string& token, char end) {
    if (end == ']' || peek() != ',' || !is_digit(peek(1))) {
      return true;
    }
    std::size_t after = 1;
    while (is_digit(peek(after))) ++after;
    std::size_t sign = after;
    while (is_blank(peek(sign))) ++sign;
    if (end == '}' && (peek(sign) == '=' || is_bare(peek(after)) || peek(after) == '.')) {
      return true;  // the next key of the table
    }
    const std::string decimals(text_.substr(at_ + 1, after - 1));
    return fail(line_, fmt::format("{},{} has a decimal comma; write {}.{}", token, decimals, token,
                                   decimals));
  }

  bool time_after_date(const std::string& token) {
    if (token.size() == 10 && token[4] == '-' && peek() == ' ' && is_digit(peek(1)) &&
        is_digit(peek(2)) && peek(3) == ':') {
      for (++at_; !line_ended() && !is_blank(peek()) &&
                  std::string_view(",]}#").find(peek()) == std::string_view::npos;) {
        ++at_;
      }
    }
    return true;
  }

  bool end_of_statement() {
    skip_blanks();
    skip_comment();
    if (line_ended()) {
      return true;
    }
    return fail_look_alike()
               ? false
               : fail(line_,
                      fmt::format("\"{}\" follows the value; delete it, or write # before it",
                                  short_text(rest_without_comment())));
  }

  std::string_view text_;
  std::size_t at_{0};
  unsigned line_{1};
  int tables_of_lists_{0};          // [[NAME]], and all that follow
  Path table_;                      // in which keys are defined now
  std::map<Path, unsigned> given_;  // keys and tables, and their lines
  std::optional<TomlMistake> found_;
  bool gave_up_{false};
};

}  // namespace

std::optional<TomlMistake> find_toml_mistake(std::string_view text) {
  auto bytes = find_bad_bytes(text);
  auto written = Walk(text).mistake();
  return bytes && (!written || bytes->line <= written->line) ? bytes : written;
}

}  // namespace haptrial
