#include "core/base/definition/toml_mistake_internal.h"

#include <fmt/format.h>

#include <map>

#include "core/base/definition/toml_scalars_internal.h"
#include "core/base/definition/toml_words_internal.h"

namespace haptrial {
namespace {

constexpr int kDeepest =
    100;  // arrays and tables in each other; deeper ones are left to the parser

/// Walks through a document statement by statement and stops at the first mistake. Every step
/// returns whether to go on.
class Walk : private TomlScalars {
 public:
  explicit Walk(std::string_view text) : TomlScalars(text) {
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
        while (is_bare(peek())) {
          ++at_;
        }
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

  int tables_of_lists_{0};          // [[NAME]], and all that follow
  Path table_;                      // in which keys are defined now
  std::map<Path, unsigned> given_;  // keys and tables, and their lines
};

}  // namespace

std::optional<TomlMistake> find_toml_mistake(std::string_view text) {
  auto bytes = find_bad_bytes(text);
  auto written = Walk(text).mistake();
  return bytes && (!written || bytes->line <= written->line) ? bytes : written;
}

}  // namespace haptrial
