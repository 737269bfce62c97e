#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "core/base/definition/toml_cursor_internal.h"
#include "core/base/definition/toml_mistake_internal.h"

namespace haptrial {

/// Reads the values of a TOML text that hold no others, and keeps the first mistake. Every step
/// returns whether to go on.
class TomlScalars : public TomlCursor {
 public:
  using TomlCursor::TomlCursor;

  /// A text in quotes, in one line or in several.
  bool short_string();
  bool long_string();
  /// A number, time, true or false. @param end  what closes what is around it: ']', '}', or '\n'
  ///                                            for nothing
  bool word(char end);

  bool fail(unsigned line, std::string sentence);
  bool give_up();
  /// A character of a word processor at this place.
  bool fail_look_alike();

 protected:
  std::optional<TomlMistake> found_;
  bool gave_up_{false};

 private:
  /// Whether the text that this line leaves open is closed in a later one.
  bool goes_on(char quote);
  bool fail_unquoted(std::size_t begin, char end, std::string text);
  /// "0,5": in an array that is two values.
  bool decimal_point(const std::string& token, char end);
  bool time_after_date(const std::string& token);
};

}  // namespace haptrial
