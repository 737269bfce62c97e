#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/definition/translations.h"

namespace haptrial::protocols {

/// The file with a definition's texts in another language: DEFINITION.texts.LANGUAGE.toml for
/// DEFINITION.toml, or texts.LANGUAGE.toml for all definitions of the folder. Empty: there is none.
std::filesystem::path language_file(const std::filesystem::path& definition,
                                    const std::string& language);

/// DEFINITION.texts.LANGUAGE.toml, whether it is there or not.
std::filesystem::path own_language_file(const std::filesystem::path& definition,
                                        const std::string& language);

/// @throws InputError unless it is a word such as de or pt-BR
void check_language(const std::string& language);

/// The languages for which a definition has a file of its own or its folder has one, by name.
std::vector<std::string> languages_of(const std::filesystem::path& definition);

/// Texts of a definition in a language: those of its file, and the program's own words.
/// @throws InputError if there is neither, or the file is wrong
Translations translations_for(const std::filesystem::path& definition, const std::string& language);

/// Reads them from the text of that file, which a session keeps; from an empty one the program's
/// own words alone.
/// @param session  that sentences name  @throws InputError if the text is wrong
Translations recorded_translations(const std::string& language, std::string text,
                                   std::string_view session);

/// The words of the program itself that participants read, in another language, by the English
/// ones; empty for a language that the program does not speak.
std::map<std::string, std::string, std::less<>> program_words(std::string_view language);

/// The languages beside English: "de".
const std::vector<std::string>& program_languages();

}  // namespace haptrial::protocols
