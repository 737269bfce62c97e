#pragma once

#include <string>
#include <string_view>

namespace haptrial {

/// A definition without a key, a table with all that it holds, or an entry of an array of tables.
/// Comments stay, even those of a line whose key is removed; those within a list go with the list.
/// @param key  path as in GivenKey: "blocks.hard" or "blocks.2" is an entry
/// @throws InputError for a text that is not TOML and for a key that it does not have
std::string without_key(std::string_view text, std::string_view file_name, const std::string& key);

/// A definition with one more entry, empty as yet, at the end of an array of tables; the array is
/// begun if the text lacks it. Nothing else of the text changes.
/// @param key  path of the array: "blocks"
/// @throws InputError for a text that is not TOML and for a key that has another value
std::string with_new_entry(std::string_view text, std::string_view file_name,
                           const std::string& key);

}  // namespace haptrial
