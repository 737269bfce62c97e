#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "core/base/definition/toml_mistake_internal.h"

namespace haptrial {

// What is wrong with single words and characters of a text that is not TOML, in plain words.

/// At most 40 bytes of `text`, whole characters.
std::string short_text(std::string_view text);

/// The typographic quote, space or dash of a word processor with which `text` begins, if any.
std::optional<std::string> look_alike_mistake(std::string_view text);

/// Whether a word without quotes is a number, date or time of TOML.
bool is_number_or_time(const std::string& word);

/// What is wrong with a word that begins like a number but is none, or that another language takes
/// for true or false; nothing for other words.
std::optional<std::string> word_mistake(const std::string& word);

/// The first control character, and the first bytes that are not UTF-8.
std::optional<TomlMistake> find_bad_bytes(std::string_view text);

}  // namespace haptrial
