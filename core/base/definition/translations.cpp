#include "core/base/definition/translations.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <toml++/toml.h>
#include <algorithm>

#include "core/base/definition/toml_text_internal.h"
#include "core/base/error.h"
#include "core/base/file_text.h"
#include "core/base/nearest.h"

namespace haptrial {
namespace {

void take_texts(const toml::table& table, const std::string& path, Translations& into) {
  for (const auto& [key, value] : table) {
    const std::string name =
        path.empty() ? std::string(key.str()) : fmt::format("{}.{}", path, key.str());
    if (const toml::table* inner = value.as_table()) {
      take_texts(*inner, name, into);
    } else if (const auto text = value.value_exact<std::string>(); text && !text->empty()) {
      into.by_key[name] = *text;
    } else {
      throw InputError(
          fmt::format("{}:{}: {} is not a text; allowed: a text in quotes that is not empty",
                      into.file, value.source().begin.line, name));
    }
  }
}

/// "{time}"; a brace that is not closed with all that follows it.
std::vector<std::string> words_in_braces(std::string_view text) {
  std::vector<std::string> words;
  for (std::size_t at = text.find('{'); at != std::string_view::npos; at = text.find('{', at + 1)) {
    const std::size_t end = text.find('}', at);
    words.emplace_back(text.substr(at, end == std::string_view::npos ? end : end + 1 - at));
  }
  return words;
}

}  // namespace

const std::string* Translations::of(std::string_view key, std::string_view text) const {
  if (const auto found = by_key.find(key); found != by_key.end()) {
    return &found->second;
  }
  const auto found = by_text.find(text);
  return found != by_text.end() ? &found->second : nullptr;
}

Translations load_translations(const std::filesystem::path& file, std::string_view language) {
  return parse_translations(file_text(file), file.string(), language);
}

Translations parse_translations(std::string text, std::string_view file_name,
                                std::string_view language) {
  Translations translations{std::string(language), std::string(file_name)};
  take_texts(parse_toml(text, translations.file), "", translations);
  translations.file_text = std::move(text);
  return translations;
}

std::vector<std::string> unknown_translations(const Translations& translations,
                                              const std::vector<ShownText>& shown) {
  std::vector<std::string> known;
  std::transform(shown.begin(), shown.end(), std::back_inserter(known),
                 [](const ShownText& text) { return text.key; });
  std::vector<std::string> sentences;
  for (const auto& [key, text] : translations.by_key) {
    if (std::find(known.begin(), known.end(), key) == known.end()) {
      const std::string hint = did_you_mean(key, known);
      sentences.push_back(
          fmt::format("{}: {} is no text that participants of this definition read{}",
                      translations.file, key, hint));
    }
  }
  return sentences;
}

std::vector<std::string> unknown_placeholders(const Translations& translations,
                                              const std::vector<ShownText>& shown,
                                              std::string_view file) {
  std::vector<std::string> sentences;
  for (const ShownText& text : shown) {
    for (const std::string& word :
         text.placeholders.empty() ? std::vector<std::string>() : words_in_braces(text.text)) {
      if (std::ranges::find(text.placeholders, word) == text.placeholders.end()) {
        const bool by_key = translations.by_key.contains(text.key);
        sentences.push_back(fmt::format("{}: {} has {}, which stands for nothing; allowed: {}",
                                        by_key ? translations.file : file, text.key, word,
                                        fmt::join(text.placeholders, ", ")));
      }
    }
  }
  return sentences;
}

std::vector<std::string> missing_translations(const Translations& translations,
                                              const std::vector<ShownText>& shown) {
  std::vector<std::string> sentences;
  for (const ShownText& text : shown) {
    if (!text.translated) {
      sentences.push_back(fmt::format("{}: {} is missing; it is shown as the definition has it",
                                      translations.file, text.key));
    }
  }
  return sentences;
}

}  // namespace haptrial
