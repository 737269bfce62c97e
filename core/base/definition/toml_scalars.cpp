#include "core/base/definition/toml_scalars_internal.h"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>
#include <utility>

#include "core/base/definition/toml_words_internal.h"

namespace haptrial {

bool TomlScalars::fail(unsigned line, std::string sentence) {
  found_ = TomlMistake{line, std::move(sentence)};
  return false;
}

bool TomlScalars::give_up() {
  gave_up_ = true;
  return false;
}

bool TomlScalars::fail_look_alike() {
  const auto mistake = look_alike_mistake(text_.substr(at_));
  return mistake && !fail(line_, *mistake);
}

bool TomlScalars::long_string() {
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
      for (int more = 0; more < 2 && peek() == quotes[0]; ++more) {
        ++at_;
      }  // quotes at its end
      return true;
    }
  }
  return fail(line, fmt::format("the text that begins with {} here is never closed; write {} at "
                                "its end",
                                quotes, quotes));
}

bool TomlScalars::goes_on(char quote) {
  const auto [at, line] = std::pair(at_, line_);
  bool closed = false;
  while (!closed && !ended()) {
    while (!line_ended()) {
      ++at_;
    }
    while (peek() == '\r') {
      ++at_;
    }
    if (!ended()) {
      next();
    }
    const std::string_view rest = rest_of_line();
    if (ended() || statement_begins()) {
      break;
    }
    const auto quotes = std::count(rest.begin(), rest.end(), quote);
    closed = quotes % 2 == 1;
    if (quotes > 0 && !closed) {
      break;
    }
  }
  std::tie(at_, line_) = std::pair(at, line);
  return closed;
}

bool TomlScalars::short_string() {
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
    return fail(line_, fmt::format("a text of several lines needs {0}{0}{0} at both ends", quote));
  }
  std::string_view line = text_.substr(begin, at_ - begin);
  return fail(line_, fmt::format("the text {} has no closing quote; write {} at its end",
                                 short_text(line), quote));
}

bool TomlScalars::fail_unquoted(std::size_t begin, char end, std::string text) {
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

bool TomlScalars::decimal_point(const std::string& token, char end) {
  if (end == ']' || peek() != ',' || !is_digit(peek(1))) {
    return true;
  }
  std::size_t after = 1;
  while (is_digit(peek(after))) {
    ++after;
  }
  std::size_t sign = after;
  while (is_blank(peek(sign))) {
    ++sign;
  }
  if (end == '}' && (peek(sign) == '=' || is_bare(peek(after)) || peek(after) == '.')) {
    return true;  // the next key of the table
  }
  const std::string decimals(text_.substr(at_ + 1, after - 1));
  return fail(line_, fmt::format("{},{} has a decimal comma; write {}.{}", token, decimals, token,
                                 decimals));
}

bool TomlScalars::time_after_date(const std::string& token) {
  if (token.size() == 10 && token[4] == '-' && peek() == ' ' && is_digit(peek(1)) &&
      is_digit(peek(2)) && peek(3) == ':') {
    for (++at_; !line_ended() && !is_blank(peek()) &&
                std::string_view(",]}#").find(peek()) == std::string_view::npos;) {
      ++at_;
    }
  }
  return true;
}

bool TomlScalars::word(char end) {
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

}  // namespace haptrial
