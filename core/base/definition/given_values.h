#pragma once

#include <span>
#include <string>
#include <string_view>

namespace haptrial {

/// A key of a definition and the value that it is given, as a definition writes it: "12", "0.05",
/// "'curl'". Of an array of tables the name or number (from 1) of the table: "blocks.hard.shift".
struct GivenKey {
  std::string key;
  std::string value;
};

/// A definition in which keys have other values. Nothing else of the text changes, not even the
/// order of keys; a key that is not there is added to its table, and the table if need be.
/// @throws InputError for a text that is not TOML, or a key that leads through something that is no
/// table
std::string with_values(std::string_view text, std::string_view file_name,
                        std::span<const GivenKey> given);

}  // namespace haptrial
