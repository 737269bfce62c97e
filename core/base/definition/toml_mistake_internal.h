#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace haptrial {

struct TomlMistake {
  unsigned line;         // where the mistake is, from 1; not where a parser notices it
  std::string sentence;  // what is wrong and what to write instead
};

/// The first common mistake of a text that is not TOML, in plain words: a bracket, brace or quote
/// that is not closed, a missing value or "=", a key or table given twice, a decimal comma, a word
/// without quotes, typographic quotes. Nothing if the mistake is of another kind; nothing for every
/// text that is TOML (TomlMistakeTest.FindsNothingInWhatIsToml).
std::optional<TomlMistake> find_toml_mistake(std::string_view text);

}  // namespace haptrial
