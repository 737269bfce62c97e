#include "protocols/definition/languages.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>
#include <string_view>
#include <system_error>

#include "core/base/error.h"
#include "protocols/definition/program_words.h"

namespace haptrial::protocols {
namespace {

namespace fs = std::filesystem;

std::string own_begin(const fs::path& definition) { return definition.stem().string() + ".texts."; }

constexpr std::string_view kCommonBegin = "texts.";
constexpr std::string_view kEnd = ".toml";

/// Language between the beginning and the end of a file's name; empty if it is another name or no
/// language's.
std::string between(const std::string& name, std::string_view begin) {
  if (!name.starts_with(begin) || !name.ends_with(kEnd) ||
      name.size() <= begin.size() + kEnd.size()) {
    return "";
  }
  const std::string word = name.substr(begin.size(), name.size() - begin.size() - kEnd.size());
  return word.find('.') == std::string::npos ? word : "";
}

}  // namespace

fs::path language_file(const fs::path& definition, const std::string& language) {
  std::error_code ignored;
  for (const std::string& begin : {own_begin(definition), std::string(kCommonBegin)}) {
    const fs::path file = definition.parent_path() / (begin + language + std::string(kEnd));
    if (fs::is_regular_file(file, ignored)) {
      return file;
    }
  }
  return {};
}

fs::path own_language_file(const fs::path& definition, const std::string& language) {
  return definition.parent_path() / (own_begin(definition) + language + std::string(kEnd));
}

void check_language(const std::string& language) {
  constexpr std::size_t kLongest = 16;
  const bool plain = std::all_of(language.begin(), language.end(), [](unsigned char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-';
  });
  if (!plain || language.empty() || language.size() > kLongest) {
    throw InputError(
        fmt::format("--language is '{}'; allowed: a language such as de or pt-BR", language));
  }
}

std::vector<std::string> languages_of(const fs::path& definition) {
  std::set<std::string> languages;
  std::error_code ignored;
  const fs::path folder = definition.has_parent_path() ? definition.parent_path() : fs::path(".");
  for (const auto& entry : fs::directory_iterator(folder, ignored)) {
    const std::string name = entry.path().filename().string();
    for (const std::string& language :
         {between(name, own_begin(definition)), between(name, kCommonBegin)}) {
      if (!language.empty()) {
        languages.insert(language);
      }
    }
  }
  return {languages.begin(), languages.end()};
}

Translations translations_for(const fs::path& definition, const std::string& language) {
  check_language(language);
  const fs::path file = language_file(definition, language);
  const std::vector<std::string>& known = program_languages();
  const bool program_speaks = std::find(known.begin(), known.end(), language) != known.end();
  if (file.empty() && !program_speaks) {
    const std::vector<std::string> there = languages_of(definition);
    throw InputError(
        fmt::format("{}: there is no {}{}{} with texts for --language {}; languages there: {}",
                    definition.string(), own_begin(definition), language, kEnd, language,
                    there.empty() ? fmt::format("{}", fmt::join(known, ", "))
                                  : fmt::format("{}", fmt::join(there, ", "))));
  }
  Translations translations =
      file.empty() ? Translations{language, own_language_file(definition, language).string()}
                   : load_translations(file, language);
  translations.by_text = program_words(language);
  return translations;
}

}  // namespace haptrial::protocols
