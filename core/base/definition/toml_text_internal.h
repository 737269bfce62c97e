#pragma once

#include <string_view>

#include <toml++/toml.h>

namespace haptrial {

/// What a definition holds. Keys that lie deeper in each other than any definition needs are
/// refused before they are read: they would overflow the stack.
/// @throws InputError when the text is not TOML, with the line.
toml::table parse_toml(std::string_view text, std::string_view file_name);

}  // namespace haptrial
