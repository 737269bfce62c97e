#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace haptrial {

/// A text of a definition that participants read.
struct ShownText {
  std::string key;         // "response.question"
  std::string text;        // in the language that is wanted, if it has that
  bool translated{false};  // false without translations, too
  std::vector<std::string>
      placeholders{};  // "{time}": what stands for something; none: all is text
};

/// Texts of a definition in another language.
struct Translations {
  std::string language;                                       // "de"; empty: the definition's own
  std::string file;                                           // that by_key is from
  std::map<std::string, std::string, std::less<>> by_key{};   // of this definition
  std::map<std::string, std::string, std::less<>> by_text{};  // of any: the program's own words
  std::string file_text{};                                    // the whole file, as it was read

  /// The translation of a text: by its key, or else by its words. Null: there is none.
  const std::string* of(std::string_view key, std::string_view text) const;
};

/// Reads a file that holds translations under the keys of the definition, and nothing else:
///
///     [texts]
///     rest = "Zeit für eine Pause"
///     [response]
///     question = "Hat es gezogen?"
///     choices.yes.label = "Ja"
///
/// @throws InputError if it cannot be read, is not TOML, or has a value that is not a text
Translations load_translations(const std::filesystem::path& file, std::string_view language);
/// Reads the text of such a file, which a session keeps. @throws InputError as above
/// @param file_name  that sentences name
Translations parse_translations(std::string text, std::string_view file_name,
                                std::string_view language);

/// Sentences for keys of the file that the definition does not show, with the nearest that it does.
std::vector<std::string> unknown_translations(const Translations& translations,
                                              const std::vector<ShownText>& shown);
/// Sentences for words in braces that stand for nothing, in texts that have placeholders.
/// @param file  of the definition
std::vector<std::string> unknown_placeholders(const Translations& translations,
                                              const std::vector<ShownText>& shown,
                                              std::string_view file);
/// Sentences for texts that have no translation.
std::vector<std::string> missing_translations(const Translations& translations,
                                              const std::vector<ShownText>& shown);

}  // namespace haptrial
